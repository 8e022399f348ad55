// `kadans tune`: seeks parameters with which scenarios go best. The search is a program of its own, kadans-tune, beside
// this one: its library takes longer to load than a short run takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kadans/app/assembly.h"
#include "kadans/campaign/tuning_score.h"

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
  double wait_s = 600;  // for the other shards' part of a generation
  std::string out;      // folder; "" = tunings/NAME-HASH
  std::string write;    // file; "" = robot.json in that folder
  bool overwrite = false;
  bool json = false;
};
void add_tune(CLI::App& app, TuneOptions& options);

// Becomes kadans-tune with the same arguments; returns only when that cannot be. Throws InputError.
int start_tune_program(char** argv);

// The robot that all scenarios of the plan share. Throws InputError when they do not.
Robot tuned_robot(const TunePlan& plan, const PluginGate& gate = {});
// What the plan tunes in it. Throws InputError for patterns that choose nothing, ranges that a parameter has not, and a
// start outside the range.
std::vector<TunedAxis> tuned_axes(const TunePlan& plan, const Robot& robot);

// What is wrong in a plan beyond its fields. Throws InputError; else says what it is.
std::string check_tune_plan(const std::string& file, const PluginGate& gate);

}  // namespace kadans
