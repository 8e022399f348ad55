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
  std::vector<std::string> tags;
  std::uint64_t seed = 1;
  std::uint32_t repeat = 1;
  double wall_limit_s = 60;
};

// All scenarios in a folder and below it, by path. A JSON file is a scenario when its schema or its keys say so; others
// are passed over. Throws InputError with everything that is wrong in any of them.
std::vector<FoundScenario> scenarios_in(const std::filesystem::path& folder);

// Of the scenarios in `folder` those that a selector chooses, each once: a file or a folder, a tag, or a pattern over
// the names ('*' for anything; without one, a part of the name). Without selectors all. Throws InputError for a
// selector that chooses nothing, with the nearest name or tag.
std::vector<FoundScenario> find_scenarios(const std::filesystem::path& folder,
                                          const std::vector<std::string>& selectors);

}  // namespace kadans
