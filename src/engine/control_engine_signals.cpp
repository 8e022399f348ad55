#include "kadans/engine/control_engine.h"
#include "kadans/estimate/signals.h"

namespace kadans {

void ControlEngine::declare_signals(Catalog& catalog) {
  SignalTable& table = catalog.signals;
  kadans::declare_signals(table, *catalog.model, estimator_.settings(), snapshot_.joints, snapshot_.status);
  for (std::size_t i = 0; i < catalog.model->joints.size(); ++i) {
    table.add({"actuation." + catalog.model->joints[i].name + ".effort_Nm", "Nm", "Torque asked of the drive."},
              &written_.joints[i].effort_Nm);
  }
  table.add({"engine.commands.applied", "", "Commands applied since the start."}, &inbox_.state().applied);
  table.add({"engine.commands.refused", "", "Commands refused since the start."}, &inbox_.state().refused);
  table.add({"engine.control_sets", "", "Active control sets, a bit each, in the order of the configuration."},
            &snapshot_.control_sets);
  safety_.declare_signals(table, *catalog.model);
}

void ControlEngine::declare_joystick(SignalTable& table) const {
  const JoystickState& joystick = snapshot_.joystick;
  constexpr const char* docs[joystick_axes] = {"To the right, -1..1.", "Away from the hand, -1..1.",
                                               "Clockwise from above, -1..1.", "Forward, -1..1."};
  for (std::size_t i = 0; i < joystick_axes; ++i) {
    table.add({std::string("joystick.") + joystick_axis_names[i], "", docs[i]}, &joystick.axes[i]);
  }
  for (std::size_t i = 0; i < joystick_buttons; ++i) {
    table.add({"joystick.button_" + std::to_string(i + 1), "", "1 while it is held."}, &joystick.buttons[i]);
  }
  table.add({"joystick.connected", "", "1 while there is one."}, &joystick.connected);
}

}  // namespace kadans
