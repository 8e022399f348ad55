// Shipped control objects as a plug-in, under other names: "plugged_joint_pid".
#include "../made_objects.h"
#include "control/balance/dcm_balance.h"
#include "control/balance/stance.h"
#include "control/balance/support_forces.h"
#include "control/drive/spring_torque.h"
#include "control/joint/trajectory_list.h"
#include "control/walk/dcm_walk.h"
#include "control/walk/stance_leg.h"
#include "kadans/control/plugin.h"

#define PLUGGED(type) kadans::plugin_type<kadans::make_##type>("plugged_" #type)

KADANS_PLUGIN(PLUGGED(joint_pid), PLUGGED(joint_cascade), PLUGGED(joint_impedance), PLUGGED(joint_integrator),
              PLUGGED(joint_velocity), PLUGGED(trajectory_list), PLUGGED(profile_position), PLUGGED(feedforward_player),
              PLUGGED(computed_torque), PLUGGED(dcm_balance), PLUGGED(dcm_walk), PLUGGED(stance), PLUGGED(stance_leg),
              PLUGGED(gravity_compensation), PLUGGED(gaze), PLUGGED(spring_torque), PLUGGED(support_forces),
              PLUGGED(task_impedance), PLUGGED(whole_body))
