#include "shipped_types.h"

#include "kadans/control/computed_torque.h"
#include "kadans/control/dcm_balance.h"
#include "kadans/control/dcm_step.h"
#include "kadans/control/feedforward_player.h"
#include "kadans/control/gaze.h"
#include "kadans/control/gravity_compensation.h"
#include "kadans/control/joint_cascade.h"
#include "kadans/control/joint_impedance.h"
#include "kadans/control/joint_integrator.h"
#include "kadans/control/joint_pid.h"
#include "kadans/control/joint_velocity.h"
#include "kadans/control/profile_position.h"
#include "kadans/control/spring_torque.h"
#include "kadans/control/stance.h"
#include "kadans/control/task_impedance.h"
#include "kadans/control/trajectory_list.h"

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
