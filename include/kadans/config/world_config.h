// The "world" of a scenario: a list of what stands, lies, rolls and swings around the robot, the ground's slope and
// motion, and what the robot is given to carry. Which keys an entry has follows from its kind; plant/world.h says what
// they mean.
#pragma once

#include <string>
#include <vector>

#include "kadans/config/fields.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/world_settings.h"

namespace kadans {

struct WorldConfig {
  WorldSettings settings;
  TextPlace place;                       // in a file that has one
  std::vector<TextPlace> payload_links;  // where each payload's link is named
};

// The list under the key "world".
void world_fields(Fields& f, WorldConfig& world, Problems& problems);

// The settings for this robot. Throws InputError when a payload's link is not one of its links.
const WorldSettings& world_for(const WorldConfig& world, const RobotModel& model, const std::string& file);

// Names of the objects, in the order of the plant's truth.
std::vector<std::string> object_names(const WorldSettings& world);

}  // namespace kadans
