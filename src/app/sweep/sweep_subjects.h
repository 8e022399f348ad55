// Plans of sweeps and tunings: reads and checks their scenarios before anything runs, with the quantities of their
// robots and a hash of everything that they depend on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "app/assembly/robot.h"
#include "campaign/sweep/sweep_case.h"
#include "campaign/sweep/tuning_score.h"
#include "config/scenario/scenario_config.h"

namespace kadans {

// Throws InputError with all mistakes in the scenarios' files, in the plan's metrics, and in the ranges of varied
// quantities.
std::vector<SweepSubject> read_sweep_subjects(const ExperimentConfig& plan, const PluginGate& gate = {});

// The path of the program that runs scenarios: this program, or `kadans` beside kadans-tune.
std::string run_program_path();
// The program's version with a hash of its file, so that results of two builds are not mixed.
std::string build_version();

// Check a plan beyond its fields: patterns, ranges, signals. Throw InputError with all mistakes. Return a description
// of the plan.
std::string check_sweep_plan(const std::string& file, const PluginGate& gate);
std::string check_tune_plan(const std::string& file, const PluginGate& gate);

// `kadans tune`: searches the parameters with which the scenarios have the best score. The search is a separate
// program, kadans-tune, beside this one, because its library takes longer to load than a short run takes. Both have the
// same options.
struct TuneOptions {
  std::string plan;
  std::optional<std::uint64_t> seed;
  std::optional<std::uint32_t> generations, runs;
  unsigned jobs = 0;
  std::string shard;
  double wait_s = 600;  // time to wait for the other shards' part of a generation
  std::string out;      // folder; "": tunings/NAME-HASH
  std::string write;    // file; "": robot.json in that folder
  bool overwrite = false;
  bool json = false;
};
void add_tune_options(CLI::App& tune, TuneOptions& options);

// The robot of all scenarios of the plan. Throws InputError when they have different robots.
Robot tuned_robot(const TunePlan& plan, const PluginGate& gate = {});
// The parameters of the robot that the plan tunes. Throws InputError for a pattern that chooses nothing, for a range
// outside a parameter's range, and for a start outside the range.
std::vector<TunedAxis> tuned_axes(const TunePlan& plan, const Robot& robot);

}  // namespace kadans
