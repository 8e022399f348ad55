#include "engine/tick/control_engine.h"
#include "estimate/signals.h"
#include "signal/status_fields.h"

namespace kadans {

void ControlEngine::declare_signals(Catalog& catalog) {
  SignalTable& table = catalog.signals;
  kadans::declare_signals(table, *catalog.model, estimator_.settings(), snapshot_);
  constexpr const char* axes[] = {"x", "y", "z"};
  for (std::size_t i = 0; i < 3; ++i) {
    table.add({std::string("imu.acceleration_") + axes[i] + "_m_s2", "m/s2",
               std::string("What the accelerometer says along the base's ") + axes[i] + " axis; at rest 9.81 upwards."},
              &sensors_.imu.acceleration_m_s2[i]);
  }
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
  declare_part(table, StatusField::Part::joystick, "joystick", snapshot_);
}

}  // namespace kadans
