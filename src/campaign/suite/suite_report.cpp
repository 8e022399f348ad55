#include "suite_report.h"

#include <algorithm>
#include <cstdio>

#include "signal/number_text.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

constexpr std::size_t transitions_shown = 6;

std::string painted(const SuiteStyle& style, const char* code, const std::string& text) {
  return style.color ? "\033[" + std::string(code) + "m" + text + "\033[0m" : text;
}

std::string title(const RunOutcome& run) {
  return run.scenario + printed(" (seed %llu)", static_cast<unsigned long long>(run.seed));
}

std::string indented(const std::string& text, const char* by) {
  std::string lines = by;
  for (const char c : text) {
    lines += c;
    if (c == '\n') lines += by;
  }
  return lines;
}

std::string plotted(const EvidenceTrace& trace, const SuiteStyle& style) {
  return curve_text(trace.signal + (trace.unit.empty() ? "" : ", " + trace.unit), trace.values, trace.from_s,
                    trace.to_s, {.rows = 3, .indent = 4, .unicode = style.unicode, .color = style.color});
}

std::string checks_of(const RunOutcome& run, const SuiteStyle& style) {
  std::string text;
  for (const CheckResult& check : run.checks) {
    if (check.passed) continue;
    text += "    " + painted(style, "31", check.name) + printed(": %g at %.3f s", check.value, check.at_s) +
            wanted_clause(check) + '\n';
    for (const EvidenceTrace& trace : run.traces) {
      if (trace.check == check.name && !trace.values.empty()) text += plotted(trace, style);
    }
  }
  return text;
}

}  // namespace

std::string suite_line(const RunOutcome& run, const SuiteStyle& style) {
  const bool passed = run.status == RunStatus::passed;
  const std::string mark = passed ? painted(style, "32", style.unicode ? "✓" : "ok")
                                  : painted(style, "31;1", style.unicode ? "✗" : "FAILED");
  std::string text = "  " + mark + " " + title(run) + printed("  %.2f s", run.wall_s);
  if (run.simulated_s > 0 && run.wall_s > 0) text += printed(", %.1f times real time", run.simulated_s / run.wall_s);
  return text + (passed ? "" : std::string("  ") + name(run.status)) + '\n';
}

std::string failure_report(const RunOutcome& run, const SuiteStyle& style) {
  std::string text = "  " + painted(style, "31;1", title(run)) + ": " + name(run.status) + '\n';
  text += checks_of(run, style);
  for (const std::string& error : run.errors) text += indented(error, "    ") + '\n';
  const std::size_t first = run.transitions.size() > transitions_shown ? run.transitions.size() - transitions_shown : 0;
  for (std::size_t i = first; i < run.transitions.size(); ++i) text += "    " + run.transitions[i] + '\n';
  if (!run.quantities.empty()) {
    text += "    with";
    for (const QuantityValue& quantity : run.quantities)
      text += printed(" %s=%.6g", quantity.name.c_str(), quantity.value);
    text += '\n';
  }
  return text + "    again: " + run.repeat + '\n';
}

std::string suite_summary(const std::vector<RunOutcome>& runs, double wall_s, const SuiteStyle& style) {
  std::string text;
  std::size_t failed = 0;
  double run_s = 0, simulated_s = 0;
  for (const RunOutcome& run : runs) {
    run_s += run.wall_s;
    simulated_s += run.simulated_s;
    if (run.status == RunStatus::passed) continue;
    text += (failed++ == 0 ? "\n" : "") + failure_report(run, style);
  }
  text += printed("\n%zu runs, ", runs.size());
  text += failed == 0 ? painted(style, "32", "all passed") : painted(style, "31;1", printed("%zu failed", failed));
  return text + printed(": %.1f s simulated in %.1f s, %.1f s of work\n", simulated_s, wall_s, run_s);
}

}  // namespace kadans
