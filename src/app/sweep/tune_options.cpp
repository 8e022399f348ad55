#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "app/commands.h"
#include "app/option_checks.h"
#include "kadans/signal/nearest_name.h"
#include "signal/input_file.h"
#include "sweep_subjects.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

void verify(const TunedAxis& axis, const Parameter& parameter, Problems& problems) {
  const auto [low, high] = axis.parameter.range.of;
  const TextPlace place = axis.parameter.pattern.place;
  if (low < parameter.min || high > parameter.max)
    problems.add(place, "control." + parameter.name + " can be " + number_text(parameter.min) + ".." +
                            number_text(parameter.max) + ", not " + number_text(low) + ".." + number_text(high));
  if (axis.start < low || axis.start > high)
    problems.add(place, "control." + parameter.name + " is " + number_text(axis.start) +
                            ", outside min and max; widen them or say where to start");
}

// Replaces this process by kadans-tune with the same arguments.
int run_tune(const CommandLine& line, const TuneOptions&) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "kadans-tune";
  execv(program.c_str(), line.arguments().data());
  refuse(program, std::string("cannot be started (") + std::strerror(errno) +
                      "): tuning is a program of its own, built where libpagmo-dev is installed");
}

}  // namespace

void add_tune_options(CLI::App& tune, TuneOptions& options) {
  tune.description("Search for the parameters with the best score in scenarios");
  tune.add_option("plan", options.plan, "Plan: the parameters and the score (JSON)")->required()->type_name("PLAN");
  add_seed(tune, options.seed, "Seed of the search and of its runs (default: the plan's)");
  add_whole(tune, "--generations", options.generations, 1, 10'000, "Number of generations (default: the plan's)");
  add_whole(tune, "--runs", options.runs, 1, 10'000, "Runs of each candidate (default: the plan's)");
  add_jobs(tune, options.jobs);
  tune.add_option("--shard", options.shard,
                  "Run only this part of each generation; all parts share the folder of results")
      ->type_name("PART/PARTS");
  add_number(tune, "--wait", options.wait_s, 0.0, 1e9, "S",
             "Seconds to wait for the other parts of a generation (default: 600)");
  tune.add_option("--out", options.out,
                  "Folder of the results; runs that have a result there are not run again (default: in tunings/)")
      ->type_name("FOLDER");
  tune.add_option(
          "--write", options.write,
          "File of the tuned configuration (default: robot.json in that folder), or of the values for a program")
      ->type_name("FILE");
  tune.add_flag("--overwrite", options.overwrite, "Overwrite that file if it exists");
  tune.add_flag("--json", options.json, "Print one JSON object instead of text");
}

void add_tune(CommandLine& line) {
  const auto [tune, options] = line.add<TuneOptions>("tune", "", run_tune);
  add_tune_options(*tune, options);
}

Robot tuned_robot(const TunePlan& plan, const PluginGate& gate) {
  std::vector<std::string> robots;
  for (const ExperimentScenario& scenario : plan.scenarios) {
    robots.push_back(read_scenario_config(scenario.file).robot);
    if (robots.back() != robots.front())
      refuse(plan.file, scenario.place,
             "is of " + robots.back() + ", the first scenario of " + robots.front() +
                 ": one robot can be tuned at a time");
  }
  return read_robot(robots.front(), gate);
}

std::vector<TunedAxis> tuned_axes(const TunePlan& plan, const Robot& robot) {
  const auto system = make_control_system(robot);
  const ParameterTable& table = system->catalog.parameters;
  std::vector<std::string> names;
  for (ParameterId id = 0; id < table.size(); ++id) names.push_back("control." + table.info(id).name);
  Problems problems(plan.file);
  std::vector<TunedAxis> axes;
  for (const TunedParameter& parameter : plan.tune) {
    TunedAxis axis{.parameter = parameter, .names = {}};
    const std::vector<std::size_t> chosen = matching(parameter.pattern.name, names);
    if (chosen.empty()) {
      problems.add_unknown(parameter.pattern.place, "parameter", parameter.pattern.name, names);
      continue;
    }
    axis.start = parameter.start.value_or(table.get(static_cast<ParameterId>(chosen.front())));
    for (const std::size_t id : chosen) {
      axis.names.push_back(names[id]);
      verify(axis, table.info(static_cast<ParameterId>(id)), problems);
    }
    axes.push_back(std::move(axis));
  }
  problems.throw_if_any();
  return axes;
}

std::string check_tune_plan(const std::string& file, const PluginGate& gate) {
  const TunePlan plan = read_tune_plan(file);
  if (!plan.program.empty()) {
    return "tuning: " + std::to_string(plan.tune.size()) + " parameters, " + std::to_string(plan.generations) +
           " generations of " + std::to_string(plan.population) + " candidates, scored by " + plan.program.front().name;
  }
  const std::vector<SweepSubject> subjects = read_sweep_subjects(plan, gate);
  const std::size_t parameters = tuned_axes(plan, tuned_robot(plan, gate)).size();
  return "tuning: " + std::to_string(parameters) + " parameters, " + std::to_string(plan.generations) +
         " generations of " + std::to_string(plan.population) + " candidates, " + std::to_string(plan.runs) +
         " runs each, " + std::to_string(subjects.size()) + " scenarios";
}

}  // namespace kadans
