// Checks that the settings fit the model, before anything is built.
#pragma once

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"
#include "kadans/plant/world_settings.h"

namespace kadans::bullet {

// Throws std::invalid_argument naming the setting, its value and what it must be.
void check_settings(const RobotModel& model, const PlantSettings& settings);

// Checks that the world can be built around this robot, before anything is built.
// Throws std::invalid_argument naming the object, the setting, its value and what it must be.
void check_world(const RobotModel& model, const WorldSettings& world);

}  // namespace kadans::bullet
