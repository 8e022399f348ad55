// TULip as every engine of the plant's benchmark gets it, and the torques that hold it.
#pragma once

#include "engines.h"

namespace kadans::bench {

// Rigid drives, sensors with noise, standing with bent knees.
PlantSettings standing_settings(const RobotModel& model);
// Our plant finds where the base is when the robot touches the ground, so that another engine can start there too.
void put_on_ground(const RobotModel& model, PlantSettings& settings);

struct StandingRobot {
  RobotModel model;
  PlantSettings settings;
};
StandingRobot standing_tulip();

// PD on the joints; `depth` bends the knees from standing, 0, to a squat, 1.
std::vector<double> hold_torques(const RobotModel& model, const EngineState& state, double depth);

}  // namespace kadans::bench
