// The part of a robot's configuration that is about behaviors: what their parameters are on this robot.
#include <algorithm>

#include "config/scenario/play_item.h"
#include "robot_reader.h"

namespace kadans {

void RobotReader::behavior(Fields& entry) {
  constexpr NumberRange any_number{-1e9, 1e9};
  std::vector<NumberEntry> values;
  entry.number_entries(values, any_number, "in the parameter's unit");
  if (!entry.reading() || config_.name.empty()) return;
  const std::vector<std::string> names = playable_names({.project_file = config_.file, .robot = config_.name});
  if (std::ranges::find(names, entry.key()) == names.end()) {
    problems_.add_unknown(entry.key_place(), "behavior", entry.key(), names, "in behaviors/" + config_.name);
    return;
  }
  for (const NumberEntry& value : values) {
    config_.behavior_values.push_back({.behavior = std::string(entry.key()),
                                       .parameter = value.key,
                                       .value = value.value,
                                       .chunk = "behaviors/" + config_.name + "/" + std::string(entry.key()) + ".lua",
                                       .file = config_.file,
                                       .line = value.place.line,
                                       .column = value.place.column});
  }
}

}  // namespace kadans
