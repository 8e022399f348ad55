// The result of one run of a scenario in a process of its own, read from the process's output and exit code.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "kadans/campaign/job_pool.h"
#include "scenario/judge/metrics.h"

namespace kadans {

enum class RunStatus : std::uint8_t { passed, failed, refused, crashed, timed_out, cancelled };
const char* name(RunStatus status) noexcept;

struct RunOutcome {
  std::string scenario;  // its name
  std::string file;
  std::uint64_t seed = 0;
  RunStatus status = RunStatus::crashed;
  double wall_s = 0, simulated_s = 0;
  std::string state_hash;
  std::vector<std::string> hashes;  // one for each second, when the run was asked for them
  std::vector<CheckResult> checks;
  std::vector<EvidenceTrace> traces;     // signals around the moment at which checks failed
  std::vector<std::string> transitions;  // the last ones, one line each
  std::vector<std::string> errors;       // messages of the run, of a behavior or of the process
  std::vector<QuantityValue> quantities;
  std::vector<MetricValue> metrics;
  std::string repeat;  // the command that repeats it
  std::string json;    // the report that the run printed, "" when it printed none
};

// `outcome.out` is what `kadans sim --json` prints.
RunOutcome read_run_outcome(const JobOutcome& outcome);

// The numbers of a report by their names, "quantities" or "metrics"; NaN for one that was not finite.
std::vector<QuantityValue> named_numbers(const nlohmann::ordered_json& report, const char* key);

// The report that the run printed, and what only the parent process knows of it: {status, file, wall_s, repeat,
// scenario, seed, ...}, on one line.
std::string run_json(const RunOutcome& run);

}  // namespace kadans
