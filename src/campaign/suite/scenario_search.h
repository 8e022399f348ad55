// Finds scenarios: by path, by tag, by name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"

namespace kadans {

// The scenarios in `folder`, and below it, that at least one selector chooses, each once; without selectors all of
// them, sorted by path. They may also repeat records. A JSON file is a scenario when its schema or its keys say so;
// other files are passed over. A selector is a file, a folder, a tag, a pattern over the names with '*', or a part of a
// name. Throws InputError with all mistakes of all scenarios, and for a selector that chooses nothing, with the nearest
// name or tag.
std::vector<ScenarioConfig> find_scenarios(const std::filesystem::path& folder,
                                           const std::vector<std::string>& selectors);

}  // namespace kadans
