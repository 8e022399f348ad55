#include "shipped_types.h"

#include "control/balance/dcm_balance.h"
#include "control/balance/dcm_step.h"
#include "control/balance/stance.h"
#include "control/drive/spring_torque.h"
#include "control/dynamics/computed_torque.h"
#include "control/dynamics/gravity_compensation.h"
#include "control/dynamics/task_impedance.h"
#include "control/gaze/gaze.h"
#include "control/joint/feedforward_player.h"
#include "control/joint/joint_cascade.h"
#include "control/joint/joint_impedance.h"
#include "control/joint/joint_integrator.h"
#include "control/joint/joint_pid.h"
#include "control/joint/joint_velocity.h"
#include "control/joint/profile_position.h"
#include "control/joint/trajectory_list.h"

namespace kadans {

// One line for each type: the "type" in a robot's configuration, and the function that makes it.
void add_shipped_types(ControlObjectTypes& types) {
  types.add("joint_pid", make_joint_pid);
  types.add("joint_cascade", make_joint_cascade);
  types.add("joint_impedance", make_joint_impedance);
  types.add("joint_integrator", make_joint_integrator);
  types.add("joint_velocity", make_joint_velocity);
  types.add("trajectory_list", make_trajectory_list);
  types.add("profile_position", make_profile_position);
  types.add("feedforward_player", make_feedforward_player);
  types.add("computed_torque", make_computed_torque);
  types.add("dcm_balance", make_dcm_balance);
  types.add("dcm_step", make_dcm_step);
  types.add("stance", make_stance);
  types.add("gravity_compensation", make_gravity_compensation);
  types.add("gaze", make_gaze);
  types.add("spring_torque", make_spring_torque);
  types.add("task_impedance", make_task_impedance);
}

}  // namespace kadans
