// The "world" of a scenario: a list of the fixed and moving bodies around the robot, the slope and motion of the
// ground, what is painted on it, and the payloads that the robot carries. The kind of an entry decides which keys it
// has; plant/world_settings.h explains them.
#pragma once

#include <string>
#include <vector>

#include "config/json/fields.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/world_settings.h"

namespace kadans {

// A free object is put elsewhere, at rest.
struct ObjectCarry {
  std::size_t object = 0;
  double at_s = 0;
  Vec3 to_m{};  // its centre
};

struct WorldConfig {
  WorldSettings settings;
  std::vector<ObjectCarry> carried;
  TextPlace place;                       // of the list, in a file that has one
  std::vector<TextPlace> payload_links;  // places in the file at which the payloads' links are named
};

// Reads the list under the key "world".
void world_fields(Fields& f, WorldConfig& world);

// The settings for this robot. Throws InputError when a payload's link is not one of its links.
const WorldSettings& world_for(const WorldConfig& world, const RobotModel& model, const std::string& file);

}  // namespace kadans
