
#include "report.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "signal/number_text.h"
#include "signal/utf8.h"
#include "telemetry/plot.h"
#include "telemetry/reading/record_rows.h"

namespace kadans {
namespace {

class TextReport {
 public:
  TextReport(const RunReport& report, const ReportStyle& style) : report_(report), style_(style) {}

  std::string write() {
    timeline();
    for (const ReportTrace& trace : report_.traces) plot(trace);
    checks();
    troubles();
    figures();
    verdict();
    return std::move(text_);
  }

 private:
  std::string green(const std::string& text) const { return style_.painted("32", text); }
  std::string red(const std::string& text) const { return style_.painted("31;1", text); }
  std::string dim(const std::string& text) const { return style_.painted("2", text); }

  // By time; what a behavior says when it enters a state stands behind the transition to it.
  void timeline() {
    const char* arrow = style_.unicode ? "→" : "->";
    std::vector<std::pair<std::int64_t, std::string>> said;
    for (const Transition& t : report_.log.transitions()) {
      const std::string way = (t.from.empty() ? "" : t.from + " ") + arrow + " " + t.to;
      said.emplace_back(
          t.time_ns, shown_text(t.behavior + ": " + way) + (t.why.empty() ? "" : dim("  (" + shown_text(t.why) + ")")));
    }
    for (const LogLine& line : report_.log.lines()) {
      if (line.severity == BehaviorLog::Severity::error || !style_.verbose) continue;
      const char* mark = line.severity == BehaviorLog::Severity::warning ? "warning: " : "";
      said.emplace_back(line.time_ns, shown_text(line.behavior + ": " + mark + line.text));
    }
    std::ranges::stable_sort(said, {}, &std::pair<std::int64_t, std::string>::first);
    for (const auto& [time_ns, text] : said)
      text_ += dim(printed("  %7.2f s  ", 1e-9 * static_cast<double>(time_ns))) + text + '\n';
    for (const auto& [behavior, active] : report_.log.active().by_behavior())
      text_ += dim("  at the end  ") + shown_text(behavior + " in " + listed(active)) + '\n';
    if (!text_.empty()) text_ += '\n';
  }

  void plot(const ReportTrace& trace) {
    if (trace.values.empty()) return;
    const PlotText style{.unicode = style_.unicode, .color = style_.color};
    text_ += curve_text(trace.title, trace.values, 0, trace.duration_s, style) + '\n';
  }

  void checks() {
    std::size_t widest = 0;
    for (const CheckResult& check : report_.result.checks) widest = std::max(widest, check.name.size());
    for (const CheckResult& check : report_.result.checks) {
      const std::string mark = check.passed ? green(style_.unicode ? "✓" : "ok") : red(style_.unicode ? "✗" : "FAILED");
      text_ += "  " + mark + " " + check.name + std::string(widest - check.name.size(), ' ');
      text_ += printed("  %11.5g at %6.2f s", check.value, check.at_s) + dim("   wanted " + demand(check) + '\n');
    }
  }

  // Where its limit is set.
  static std::string key(const Fault& fault) {
    const std::string key = configuration_key(fault.code);
    return key.empty() ? "" : " (" + key + ")";
  }

  void troubles() {
    const RunResult& result = report_.result;
    for (const LogLine& line : report_.log.lines()) {
      if (line.severity == BehaviorLog::Severity::error)
        text_ += "\n" + red("  error: ") + shown_text(line.text) + '\n';
    }
    if (!result.error.empty()) text_ += "\n" + red("  the run ended early: ") + shown_text(result.error) + '\n';
    constexpr std::size_t shown = 5;
    for (std::size_t i = 0; i < std::min(result.faults.size(), shown); ++i) {
      const RunFault& fault = result.faults[i];
      text_ += red("  fault: ") + fault_name(fault.told) +
               printed(" in tick %llu: ", static_cast<unsigned long long>(fault.tick)) + fault_detail(fault.told) +
               key(fault) + "\n";
    }
    if (result.faults.size() > shown) text_ += printed("  ... and %zu more faults\n", result.faults.size() - shown);
    if (result.unsettled_steps > 0)
      text_ += printed(
          "  warning: contacts and joints were not settled in %llu steps, the worst at %.3f s by %.2g m/s: forces "
          "there "
          "are not to be trusted (plant.solver.residual_m_s; more plant.solver_iterations)\n",
          static_cast<unsigned long long>(result.unsettled_steps), result.residual_max_at_s, result.residual_max_m_s);
  }

  void figures() {
    const RunResult& r = report_.result;
    text_ +=
        printed("\n  %.2f s simulated in %.2f s: %.1f times real time\n", r.duration_s, r.wall_s, r.realtime_factor);
    text_ += printed("  %llu control ticks (median %.2f us, p99 %.2f us), %llu behavior ticks\n",
                     static_cast<unsigned long long>(r.control_ticks), 1e-3 * r.tick.median_ns, 1e-3 * r.tick.p99_ns,
                     static_cast<unsigned long long>(r.behavior_ticks));
    text_ +=
        printed("  %llu commands sent, %llu refused; state %016llx\n", static_cast<unsigned long long>(r.commands_sent),
                static_cast<unsigned long long>(r.commands_refused), static_cast<unsigned long long>(r.state_hash));
    if (!report_.record.empty()) text_ += "  record: " + report_.record + '\n';
    text_ += dim("  again:  " + report_.repeat) + "\n\n";
  }

  void verdict() {
    const RunResult& r = report_.result;
    const auto failed = std::count_if(r.checks.begin(), r.checks.end(), [](const CheckResult& c) { return !c.passed; });
    if (r.interrupted) {
      text_ += red("INTERRUPTED") + printed(" after %.2f s\n", r.duration_s);
    } else if (r.passed) {
      text_ += green("PASSED") + printed("  %zu checks\n", r.checks.size());
    } else {
      text_ += red("FAILED") + printed("  %td of %zu checks\n", failed, r.checks.size());
    }
  }

  const RunReport& report_;
  const ReportStyle& style_;
  std::string text_;
};

}  // namespace

std::string text_report(const RunReport& report, const ReportStyle& style) { return TextReport(report, style).write(); }

namespace {

using Json = nlohmann::ordered_json;

// "2.34 s  squat: down -> up (arrived)"
std::string transition_line(const Transition& transition) {
  return printed("%7.2f s  ", seconds(transition.time_ns)) + transition_text(transition);
}

Json evidence_json(const std::vector<EvidenceTrace>& traces) {
  Json json = Json::array();
  for (const EvidenceTrace& trace : traces) {
    json.push_back({{"check", trace.check},
                    {"signal", trace.signal},
                    {"unit", trace.unit},
                    {"from_s", trace.from_s},
                    {"to_s", trace.to_s},
                    {"values", trace.values}});
  }
  return json;
}

}  // namespace

std::string json_report(const RunReport& report) {
  const RunResult& result = report.result;
  Json json{{"scenario", result.scenario}, {"seed", result.seed}, {"passed", result.passed}};
  json["checks"] = Json::array();
  for (const CheckResult& check : result.checks) {
    json["checks"].push_back({{"name", check.name},
                              {"passed", check.passed},
                              {"value", check.value},
                              {"at_s", check.at_s},
                              {"wanted", check.wanted}});
    if (!check.note.empty()) json["checks"].back()["note"] = check.note;
  }
  json["duration_s"] = result.duration_s;
  json["realtime_factor"] = result.realtime_factor;
  json["control_ticks"] = result.control_ticks;
  json["behavior_ticks"] = result.behavior_ticks;
  json["state_hash"] = hash_text(result.state_hash);
  json["tick_ns"] = {{"median", result.tick.median_ns}, {"p99", result.tick.p99_ns}, {"max", result.tick.max_ns}};
  json["solver"] = {{"unsettled_steps", result.unsettled_steps},
                    {"residual_max_m_s", result.residual_max_m_s},
                    {"residual_max_at_s", result.residual_max_at_s}};
  json["queue"] = {{"sent", result.commands_sent}, {"refused", result.commands_refused}};
  json["faults"] = Json::array();
  for (const RunFault& fault : result.faults) json["faults"].push_back(fault_json(fault, fault.told));
  json["errors"] = Json::array();
  if (!result.error.empty()) json["errors"].push_back(result.error);
  for (const LogLine& line : report.log.lines()) {
    if (line.severity == BehaviorLog::Severity::error) json["errors"].push_back(line.text);
  }
  for (const std::string& what : report.lost) json["errors"].push_back(what);
  json["active"] = Json::object();
  for (const auto& [behavior, active] : report.log.active().by_behavior()) json["active"][behavior] = active;
  json["record"] = report.record;
  json["quantities"] = Json::object();
  for (const QuantityValue& quantity : report.quantities) json["quantities"][quantity.name] = quantity.value;
  if (!report.metrics.empty()) json["metrics"] = Json::object();
  for (const MetricValue& metric : report.metrics) json["metrics"][metric.name] = metric.value;
  if (!report.branch.empty()) json["branch"] = report.branch;
  for (const std::uint64_t hash : report.hashes) json["hashes"].push_back(hash_text(hash));
  if (!result.passed) {
    constexpr std::ptrdiff_t last = 20;
    const std::vector<Transition>& all = report.log.transitions();
    json["transitions"] = Json::array();
    const auto from = all.end() - std::min(last, static_cast<std::ptrdiff_t>(all.size()));
    for (auto it = from; it != all.end(); ++it) json["transitions"].push_back(transition_line(*it));
    json["evidence"] = evidence_json(report.evidence);
  }
  return json_text(json);
}

}  // namespace kadans
