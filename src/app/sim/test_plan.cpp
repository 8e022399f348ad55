#include "test_plan.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "app/assembly.h"
#include "app/line_editor.h"
#include "campaign/work/durable_file.h"
#include "config/json/foreign_json.h"
#include "kadans/signal/input_error.h"
#include "played_behaviors.h"
#include "script/check/check_behavior.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// A robot that is read once for all its scenarios. A robot that cannot be read is left to the processes of its runs;
// and so is one with plug-ins, whose native code may do anything.
struct KnownRobot {
  bool tried = false;
  Robot robot;
  std::unique_ptr<ControlSystem> system;

  const Catalog* catalog(const fs::path& file) {
    if (!std::exchange(tried, true)) {
      try {
        if (!read_plugin_files(file).empty()) return nullptr;
        robot = read_robot(file);
        system = make_control_system(robot);
      } catch (const InputError&) {
      }
    }
    return system ? &system->catalog : nullptr;
  }
};

std::string place_of(const FoundScenario& scenario) { return fs::absolute(scenario.file).lexically_normal().string(); }

}  // namespace

FailedRuns::FailedRuns(const fs::path& root)
    : file_(state_file("failed-" + std::to_string(std::hash<std::string>()(fs::absolute(root).string())))) {}

void FailedRuns::read() {
  std::ifstream stream(file_);
  for (std::string text; std::getline(stream, text);) lines_.push_back(text);
}

std::vector<PlannedRun> FailedRuns::of(const std::vector<FoundScenario>& scenarios) const {
  std::vector<PlannedRun> runs;
  for (const FoundScenario& scenario : scenarios) {
    for (const std::string& line : lines_) {
      const std::size_t blank = std::min(line.find(' '), line.size());
      const auto seed = number_of<std::uint64_t>(line.substr(0, blank));
      if (seed && line.substr(std::min(blank + 1, line.size())) == place_of(scenario))
        runs.push_back({scenario, *seed});
    }
  }
  return runs;
}

void FailedRuns::write(const std::vector<PlannedRun>& failed) const {
  if (file_.empty()) return;
  std::string text;
  for (const PlannedRun& run : failed) text += std::to_string(run.seed) + " " + place_of(run.scenario) + "\n";
  try {
    write_durably(file_, text);
  } catch (const InputError&) {
  }
}

std::vector<PlannedRun> plan_runs(const TestOptions& options, const std::vector<FoundScenario>& scenarios,
                                  FailedRuns& failed) {
  std::vector<PlannedRun> runs;
  for (const FoundScenario& scenario : scenarios) {
    const std::uint64_t first = options.seed.value_or(scenario.seed);
    for (std::uint32_t i = 0; i < options.repeat.value_or(scenario.repeat); ++i) runs.push_back({scenario, first + i});
  }
  if (!options.rerun_failed) return runs;
  failed.read();
  std::vector<PlannedRun> again = failed.of(scenarios);
  if (!options.seed && !options.repeat) return again;
  const auto chosen = [&](const PlannedRun& run) {
    return std::ranges::any_of(runs, [&](const PlannedRun& other) {
      return other.seed == run.seed && other.scenario.file == run.scenario.file;
    });
  };
  std::erase_if(again, [&](const PlannedRun& run) { return !chosen(run); });
  return again;
}

void refuse_faulty_runs(const std::vector<PlannedRun>& runs) {
  std::map<fs::path, KnownRobot> robots;
  std::set<fs::path> seen;
  std::vector<InputProblem> problems;
  for (const PlannedRun& run : runs) {
    if (!seen.insert(run.scenario.file).second) continue;
    const ScenarioConfig scenario = read_scenario_config(run.scenario.file);
    const Catalog* const catalog = robots[scenario.robot].catalog(scenario.robot);
    if (catalog == nullptr) continue;
    for (InputProblem& problem : problems_of_played(scenario, *catalog)) problems.push_back(std::move(problem));
  }
  tell_once(problems);
  if (!problems.empty()) throw InputError(problems);
}

void print_plan(const std::vector<PlannedRun>& runs, bool json) {
  for (const PlannedRun& run : runs) {
    const FoundScenario& scenario = run.scenario;
    if (json) {
      const nlohmann::ordered_json line{{"scenario", scenario.name},
                                        {"seed", run.seed},
                                        {"file", scenario.file.string()},
                                        {"tags", scenario.tags},
                                        {"doc", scenario.doc}};
      std::puts(json_text(line).c_str());
      continue;
    }
    std::string tags;
    for (const std::string& tag : scenario.tags) tags += " #" + tag;
    std::printf("%s (seed %llu)%s\n    %s\n", scenario.name.c_str(), static_cast<unsigned long long>(run.seed),
                tags.c_str(), scenario.doc.c_str());
  }
}

}  // namespace kadans
