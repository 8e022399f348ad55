// Shipped control objects as a plug-in, under other names: "plugged_joint_pid".
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
#include "kadans/control/plugin.h"
#include "kadans/control/profile_position.h"
#include "kadans/control/spring_torque.h"
#include "kadans/control/stance.h"
#include "kadans/control/task_impedance.h"
#include "kadans/control/trajectory_list.h"

#define PLUGGED(type) kadans::plugin_type<kadans::make_##type>("plugged_" #type)

KADANS_PLUGIN(PLUGGED(joint_pid), PLUGGED(joint_cascade), PLUGGED(joint_impedance), PLUGGED(joint_integrator),
              PLUGGED(joint_velocity), PLUGGED(trajectory_list), PLUGGED(profile_position), PLUGGED(feedforward_player),
              PLUGGED(computed_torque), PLUGGED(dcm_balance), PLUGGED(dcm_step), PLUGGED(stance),
              PLUGGED(gravity_compensation), PLUGGED(gaze), PLUGGED(spring_torque), PLUGGED(task_impedance))
