#include "shipped_types.h"

// A type is made by make_TYPE, which its own source defines.
#define ADD_TYPE(type)                                                  \
  std::unique_ptr<ControlObject> make_##type(const ObjectSetup& setup); \
  types.add(#type, make_##type)

namespace kadans {

// One line for each type, by its "type" in a robot's configuration.
void add_shipped_types(ControlObjectTypes& types) {
  ADD_TYPE(joint_pid);
  ADD_TYPE(joint_cascade);
  ADD_TYPE(joint_impedance);
  ADD_TYPE(joint_integrator);
  ADD_TYPE(joint_velocity);
  ADD_TYPE(trajectory_list);
  ADD_TYPE(profile_position);
  ADD_TYPE(feedforward_player);
  ADD_TYPE(computed_torque);
  ADD_TYPE(dcm_balance);
  ADD_TYPE(dcm_step);
  ADD_TYPE(stance);
  ADD_TYPE(gravity_compensation);
  ADD_TYPE(gaze);
  ADD_TYPE(spring_torque);
  ADD_TYPE(task_impedance);
}

}  // namespace kadans
