// Checks that the settings fit the model, and that the world can be built around this robot, before anything is built.
#pragma once

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"

namespace kadans::bullet {

// Throws std::invalid_argument naming the setting (and the object), its value and what it must be.
void check_settings(const RobotModel& model, const PlantSettings& settings);

}  // namespace kadans::bullet
