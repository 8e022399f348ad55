// Shipped control objects as a plug-in, under other names: "plugged_joint_pid".
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
#include "kadans/control/plugin.h"

#define PLUGGED(type) kadans::plugin_type<kadans::make_##type>("plugged_" #type)

KADANS_PLUGIN(PLUGGED(joint_pid), PLUGGED(joint_cascade), PLUGGED(joint_impedance), PLUGGED(joint_integrator),
              PLUGGED(joint_velocity), PLUGGED(trajectory_list), PLUGGED(profile_position), PLUGGED(feedforward_player),
              PLUGGED(computed_torque), PLUGGED(dcm_balance), PLUGGED(dcm_step), PLUGGED(stance),
              PLUGGED(gravity_compensation), PLUGGED(gaze), PLUGGED(spring_torque), PLUGGED(task_impedance))
