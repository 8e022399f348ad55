#include "sweep_subjects.h"

#include <filesystem>

#include "app/assembly/assembly.h"
#include "app/sim/played_behaviors.h"
#include "config/robot/project_root.h"
#include "config/scenario/based_on.h"
#include "kadans/signal/content_hash.h"
#include "scenario/judge/metrics.h"
#include "version.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// The robot's configuration with plug-ins, its description with meshes, and what it plays.
void add_robot(const Assembly& assembly, ContentHash& hash) {
  const ScenarioConfig& scenario = assembly.scenario();
  for (const fs::path& file : files_of(scenario.robot)) hash.add_file(file);
  for (const PluginFile& plugin : read_plugin_files(scenario.robot)) hash.add_file(plugin.file);
  hash.add_folder(fs::path(assembly.robot().model.file).parent_path());
  for (const PlayItem& item : scenario.behaviors) hash.add_file(item.file);
  for (const auto& other : assembly.others()) add_robot(*other, hash);
}

// A hash of the scenario, its robots, all behaviors and their libraries.
std::uint64_t content_of(const Assembly& assembly) {
  ContentHash hash;
  for (const fs::path& file : files_of(assembly.scenario().file)) hash.add_file(file);
  hash.add_folder(project_root(assembly.scenario().file) / "behaviors", ".lua");
  add_robot(assembly, hash);
  return hash.value();
}

// The ends of an axis's values: when they are in range, all values between them are.
std::vector<double> ends_of(const Distribution& distribution) {
  if (distribution.kind == Distribution::Kind::values) return distribution.values;
  return {distribution.at(0), distribution.at(1)};
}

// The quantities of the robot, once the plan's ranges are known to lie in theirs. Its control objects are gone again
// then: of some a program can have only one.
std::vector<std::string> verified_quantities(const ExperimentConfig& plan, const ScenarioConfig& scenario,
                                             Problems& problems) {
  const Robot robot = read_robot(scenario.robot, scenario.plugins);
  const auto system = make_control_system(robot);
  PlantVariant variant = plant_variant(scenario, robot.config);
  Quantities quantities(variant, system->catalog);
  for (const ExperimentAxis& axis : plan.vary) {
    const auto& [pattern, distribution] = axis.variation;
    for (const double value : ends_of(distribution)) {
      std::vector<QuantityValue> done;
      quantities.set({.key = pattern.name, .value = value, .place = pattern.place, .value_place = pattern.place}, done,
                     problems);
    }
  }
  return quantities.names();
}

SweepSubject subject_of(const ExperimentScenario& named, const ExperimentConfig& plan, const PluginGate& gate,
                        Problems& problems) {
  ScenarioConfig scenario = read_scenario_config(named.file);
  scenario.plugins = gate;
  std::vector<std::string> quantities = verified_quantities(plan, scenario, problems);
  RunLog log;
  const Assembly assembly(scenario, plan.seed, log);
  const Checks checks(assembly.catalog().signals, scenario.checks, scenario.file, assembly.signal_states());
  for (const InputProblem& problem : problems_of_played(scenario, assembly.catalog()))
    problems.add(InputError(problem));
  const Metrics metrics(assembly.catalog().signals, plan.metrics, plan.file, assembly.signal_states());
  return {.scenario = named,
          .name = scenario.name,
          .wall_limit_s = scenario.wall_limit_s,
          .randomise = scenario.randomise,
          .quantities = std::move(quantities),
          .content = content_of(assembly)};
}

}  // namespace

std::vector<SweepSubject> read_sweep_subjects(const ExperimentConfig& plan, const PluginGate& gate) {
  Problems problems(plan.file);
  std::vector<SweepSubject> subjects;
  for (const ExperimentScenario& scenario : plan.scenarios) {
    try {
      subjects.push_back(subject_of(scenario, plan, gate, problems));
    } catch (const InputError& error) {
      problems.add(error);
    }
  }
  problems.throw_if_any();
  return subjects;
}

std::string run_program_path() {
  const fs::path own = fs::read_symlink("/proc/self/exe");
  return own.filename() == "kadans-tune" ? (own.parent_path() / "kadans").string() : own.string();
}

std::string build_version() {
  ContentHash hash;
  hash.add_file(run_program_path());
  return std::string(version) + "+" + hash.hex().substr(0, 8);
}

}  // namespace kadans
