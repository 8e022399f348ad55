#include "scenario_search.h"

#include <algorithm>
#include <iterator>

#include "config/json/json_value.h"
#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

bool looks_like_scenario(const fs::path& file) {
  if (file.extension() != ".json") return false;
  const std::string text = read_input_file(file);
  return text.find("scenario.schema.json") != std::string::npos ||
         (((text.find("\"duration_s\"") != std::string::npos && text.find("\"robot\"") != std::string::npos) ||
           (text.find("\"record\"") != std::string::npos && text.find("\"checks\"") != std::string::npos)) &&
          text.find("\"$schema\"") == std::string::npos);
}

void append_new(std::vector<ScenarioConfig>& all, ScenarioConfig found) {
  const auto same = [&](const ScenarioConfig& other) { return fs::equivalent(other.file, found.file); };
  if (std::ranges::none_of(all, same)) all.push_back(std::move(found));
}

bool chooses(const std::string& selector, const ScenarioConfig& scenario) {
  if (std::ranges::find(scenario.tags, selector) != scenario.tags.end()) return true;
  if (selector.find('*') != std::string::npos) return matches(selector, scenario.name);
  return scenario.name.find(selector) != std::string::npos;
}

[[noreturn]] void refuse_selector(const std::string& selector, const std::vector<ScenarioConfig>& known,
                                  const fs::path& folder) {
  std::vector<std::string> names;
  for (const ScenarioConfig& scenario : known) {
    names.push_back(scenario.name);
    std::ranges::copy(scenario.tags, std::back_inserter(names));
  }
  refuse("no file, tag or name of a scenario in " + folder.string() + " is '" + selector + "'" +
         did_you_mean(selector, names));
}

// All in a folder and below it, sorted by path.
std::vector<ScenarioConfig> scenarios_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && looks_like_scenario(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<ScenarioConfig> found;
  std::vector<InputProblem> problems;
  for (const fs::path& file : files) {
    try {
      found.push_back(read_tested_scenario(file));
    } catch (const InputError& error) {
      std::ranges::copy(error.problems(), std::back_inserter(problems));
    }
  }
  if (!problems.empty()) throw InputError(problems);
  return found;
}

}  // namespace

std::vector<ScenarioConfig> find_scenarios(const fs::path& folder, const std::vector<std::string>& selectors) {
  const bool all_paths = std::ranges::all_of(selectors, [](const std::string& s) { return fs::exists(s); });
  std::vector<ScenarioConfig> known;
  if ((selectors.empty() || !all_paths) && fs::is_directory(folder)) known = scenarios_in(folder);
  if (selectors.empty()) return known;
  std::vector<ScenarioConfig> chosen;
  for (const std::string& selector : selectors) {
    const std::size_t before = chosen.size();
    if (fs::is_directory(selector)) {
      for (ScenarioConfig& scenario : scenarios_in(selector)) append_new(chosen, std::move(scenario));
    } else if (fs::exists(selector)) {
      append_new(chosen, read_tested_scenario(selector));
    } else {
      for (const ScenarioConfig& scenario : known) {
        if (chooses(selector, scenario)) append_new(chosen, scenario);
      }
      const bool chosen_before = std::ranges::any_of(chosen, [&](const auto& s) { return chooses(selector, s); });
      if (chosen.size() == before && !chosen_before) refuse_selector(selector, known, folder);
    }
  }
  return chosen;
}

}  // namespace kadans
