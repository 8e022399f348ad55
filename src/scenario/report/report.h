// The report of a run: as text for people, and as one JSON object for machines.
#pragma once

#include <string>
#include <vector>

#include "scenario/disturb/quantities.h"
#include "scenario/judge/metrics.h"
#include "scenario/run.h"

namespace kadans {

// A signal drawn in the report.
struct ReportTrace {
  std::string title;
  std::vector<double> values;
  double duration_s = 0;
};

// What is told of a run.
struct RunReport {
  const RunResult& result;
  const RunLog& log;
  std::string title{};   // one sentence on the scenario
  std::string record;    // file, or ""
  std::string repeat{};  // the command that repeats the run
  std::vector<ReportTrace> traces{};
  std::vector<QuantityValue> quantities{};  // quantities that were set or drawn
  std::vector<MetricValue> metrics{};
  std::vector<EvidenceTrace> evidence{};  // of the checks that failed
  std::vector<std::uint64_t> hashes{};    // state hashes at the times that the command line asked for
  std::string branch{};                   // name, or ""
  std::vector<std::string> lost{};        // output files that could not be written, or not completely
};

// {scenario, seed, passed, checks [{name, passed, value, at_s, wanted, note}], duration_s, realtime_factor,
// control_ticks, behavior_ticks, state_hash, tick_ns {median, p99, max}, queue {sent, refused}, faults [], errors [],
// active {behavior: [states]}, record, quantities {}, metrics {}, hashes [], branch, transitions [], evidence [{check,
// signal, unit, from_s, to_s, values}]}, on one line. Hashes and branch stand there only when there are any,
// transitions and evidence only when the run did not pass. Numbers that are not finite become null.
std::string json_report(const RunReport& report);

struct ReportStyle {
  bool color = false;
  bool unicode = true;
  bool verbose = false;  // with all log lines

  // The text, with `color` in the colors of this code for terminals: "31;1".
  std::string painted(const char* code, const std::string& text) const {
    return color ? "\033[" + std::string(code) + "m" + text + "\033[0m" : text;
  }
};

std::string text_report(const RunReport& report, const ReportStyle& style);

}  // namespace kadans
