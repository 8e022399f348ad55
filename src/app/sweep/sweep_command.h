// `kadans sweep` runs the cases of a plan, each in a process of its own. `kadans merge` makes one table of the results
// of several sweeps of the same plan.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct SweepOptions {
  std::string plan;
  std::optional<std::uint32_t> cases;
  std::optional<std::uint64_t> seed;
  unsigned jobs = 0;  // 0: one for each core
  std::string shard;  // "0/4"; "": the shard of a Slurm array, else all cases
  std::string out;    // "": sweeps/NAME-HASH in the working directory
  bool json = false;
};
void add_sweep(CLI::App& app, SweepOptions& options);
int run_sweep(const SweepOptions& options);

struct MergeOptions {
  std::vector<std::string> folders;
  std::string sqlite, csv, heat_map;  // files, or ""
  std::string x, y, metric;           // of the heat map; "": the plan's
  bool json = false;
};
void add_merge(CLI::App& app, MergeOptions& options);
int run_merge(const MergeOptions& options);

// Checks a plan beyond its fields: patterns, ranges, signals. Throws InputError with all mistakes. Returns a
// description of the plan.
std::string check_sweep_plan(const std::string& file, const PluginGate& gate);

}  // namespace kadans
