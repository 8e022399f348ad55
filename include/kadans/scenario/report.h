// What a run has to say: for people, and as one JSON object for machines.
#pragma once

#include <string>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/scenario/evidence.h"
#include "kadans/scenario/metrics.h"
#include "kadans/scenario/quantities.h"
#include "kadans/scenario/run.h"

namespace kadans {

// What belongs to a run beside its result.
struct ReportContext {
  const RunLog& log;
  const RobotModel& model;
  std::vector<QuantityValue> quantities;  // that were set or drawn
  std::vector<MetricValue> metrics{};
  std::vector<EvidenceTrace> evidence;  // of the checks that failed
  std::string record;                   // file, or ""
  std::vector<std::uint64_t> hashes{};  // of the state, at times that somebody asked for
  std::string branch{};                 // name, or ""
  std::vector<std::string> lost{};      // what was to be left behind and is not, or not whole
};

// {scenario, seed, passed, checks [{name, passed, value, at_s, wanted, note}], duration_s, realtime_factor,
// control_ticks, behavior_ticks, state_hash, tick_ns {median, p99, max}, queue {sent, refused}, faults [], errors [],
// record, quantities {}, metrics {}, hashes [], branch, transitions [], evidence [{check, signal, unit, from_s, to_s,
// values}]}, on one line; hashes and branch only when there are any, the transitions and the evidence only when the run
// did not pass. Numbers that are not finite become null.
std::string json_report(const RunResult& result, const ReportContext& context);

struct ReportStyle {
  bool color = false;
  bool unicode = true;
  bool verbose = false;  // all log lines
};

// A signal drawn in the report.
struct ReportTrace {
  std::string title;
  std::vector<double> values;
  double duration_s = 0;
};

struct ReportSubject {
  const RunResult& result;
  const RunLog& log;
  const RobotModel& model;
  const std::vector<ReportTrace>& traces;
  std::string title;   // one sentence on the scenario
  std::string record;  // file, or ""
  std::string repeat;  // the command that repeats the run
};

std::string text_report(const ReportSubject& subject, const ReportStyle& style);

}  // namespace kadans
