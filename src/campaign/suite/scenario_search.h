// Finds scenarios: by path, by tag, by name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace kadans {

struct FoundScenario {
  std::filesystem::path file;
  std::string name, doc;
  std::string record;  // that it repeats; "": it is simulated
  std::vector<std::string> tags;
  std::uint64_t seed = 1;
  std::uint32_t repeat = 1;
  double wall_limit_s = 60;
};

// All scenarios in a folder and below it, sorted by path. A JSON file is a scenario when its schema or its keys say so;
// other files are passed over. Throws InputError with all mistakes of all scenarios.
std::vector<FoundScenario> scenarios_in(const std::filesystem::path& folder);

// The scenarios in `folder` that at least one selector chooses, each once; without selectors all of them. A selector is
// a file, a folder, a tag, a pattern over the names with '*', or a part of a name. Throws InputError for a selector
// that chooses nothing, with the nearest name or tag.
std::vector<FoundScenario> find_scenarios(const std::filesystem::path& folder,
                                          const std::vector<std::string>& selectors);

}  // namespace kadans
