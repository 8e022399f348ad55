// The signals of joint states and robot status, under the names by which recorder, checks, viewers and scripts know
// them:
//   joint.<name>.position_rad, .velocity_rad_s, .effort_Nm
//   base.roll_rad, .pitch_rad, .yaw_rad, .tilt_rad, .height_m, .rate_x_rad_s, .rate_y_rad_s, .rate_z_rad_s
//   foot.<link>.force_N, .contact, .cop_x_m, .cop_y_m
//   support.force_N, .cop_x_m, .cop_y_m
#pragma once

#include "kadans/estimate/settings.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"

namespace kadans {

// Before the loop. joints and status are what Estimator::update fills; they must outlive the table's use. Throws
// std::invalid_argument on a name taken.
void declare_signals(SignalTable& table, const RobotModel& model, const EstimateSettings& settings,
                     const JointStates& joints, const RobotStatus& status);

}  // namespace kadans
