// A scenario: a robot, a plant, the behaviors it plays and what must hold meanwhile, in one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "kadans/config/fields.h"
#include "kadans/config/play_item.h"
#include "kadans/config/scenario_check.h"
#include "kadans/config/scenario_event.h"
#include "kadans/config/world_config.h"

namespace kadans {

enum class PlantKind : std::uint8_t { bullet, ideal };

struct ScenarioConfig {
  std::string file;
  std::string name;
  std::string doc;
  std::string robot;  // path of the robot's configuration, resolved
  PlantKind plant = PlantKind::bullet;
  double duration_s = 0;
  std::uint64_t seed = 1;
  std::vector<PlayItem> behaviors;
  std::vector<ScenarioEvent> events;
  WorldConfig world;
  std::vector<ScenarioCheck> checks;
};

// Where the names in its lists are looked for.
PlayFolders folders_of(const ScenarioConfig& scenario);

// Throws InputError with everything that is wrong. The files that it names are there, but not yet read; whether the
// signals exist is for whoever has the table: refuse_unknown(file, {check.signal, check.signal_place}, "signal", ...).
ScenarioConfig read_scenario_config(const std::filesystem::path& file);
ScenarioConfig read_scenario_config_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_scenario_config();

}  // namespace kadans
