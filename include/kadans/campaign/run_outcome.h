// What came of one run of a scenario in a process of its own, read from what the process left.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/campaign/job_pool.h"
#include "kadans/scenario/evidence.h"
#include "kadans/scenario/metrics.h"
#include "kadans/scenario/quantities.h"

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
  std::vector<std::string> hashes;  // each second, when they were asked for
  std::vector<CheckResult> checks;
  std::vector<EvidenceTrace> traces;     // of the checks that failed
  std::vector<std::string> transitions;  // the last ones, a line each
  std::vector<std::string> errors;       // what the run, a behavior or the process said
  std::vector<QuantityValue> quantities;
  std::vector<MetricValue> metrics;
  std::string repeat;  // the command that repeats it
  std::string json;    // the run's own report, "" when it left none
};

// `outcome.out` is what `kadans sim --json` prints.
RunOutcome read_run_outcome(const JobOutcome& outcome);

// The run's own report with what only the outside knows: {status, file, wall_s, repeat, scenario, seed, ...}, one line.
std::string run_json(const RunOutcome& run);

}  // namespace kadans
