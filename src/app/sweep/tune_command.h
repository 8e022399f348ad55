// `kadans tune`: searches the parameters with which the scenarios have the best score. The search is a separate
// program, kadans-tune, beside this one, because its library takes longer to load than a short run takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "app/assembly.h"
#include "campaign/sweep/tuning_score.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

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
void add_tune(CLI::App& app, TuneOptions& options);

// Replaces this process by kadans-tune with the same arguments. Throws InputError when that fails.
int start_tune_program(char** argv);

// The robot of all scenarios of the plan. Throws InputError when they have different robots.
Robot tuned_robot(const TunePlan& plan, const PluginGate& gate = {});
// The parameters of the robot that the plan tunes. Throws InputError for a pattern that chooses nothing, for a range
// outside a parameter's range, and for a start outside the range.
std::vector<TunedAxis> tuned_axes(const TunePlan& plan, const Robot& robot);

// Checks a plan beyond its fields. Throws InputError with all mistakes. Returns a description of the plan.
std::string check_tune_plan(const std::string& file, const PluginGate& gate);

}  // namespace kadans
