#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"
#include "report.h"
#include "signal/number_text.h"
#include "telemetry/reading/record_rows.h"

namespace kadans {
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

std::string json_report(const RunResult& result, const ReportContext& context) {
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
  json["queue"] = {{"sent", result.commands_sent}, {"refused", result.commands_refused}};
  json["faults"] = Json::array();
  for (const Fault& fault : result.faults) json["faults"].push_back(fault_json(fault, context.model));
  json["errors"] = Json::array();
  if (!result.error.empty()) json["errors"].push_back(result.error);
  for (const LogLine& line : context.log.lines()) {
    if (line.severity == BehaviorLog::Severity::error) json["errors"].push_back(line.text);
  }
  for (const std::string& what : context.lost) json["errors"].push_back(what);
  json["record"] = context.record;
  json["quantities"] = Json::object();
  for (const QuantityValue& quantity : context.quantities) json["quantities"][quantity.name] = quantity.value;
  if (!context.metrics.empty()) json["metrics"] = Json::object();
  for (const MetricValue& metric : context.metrics) json["metrics"][metric.name] = metric.value;
  if (!context.branch.empty()) json["branch"] = context.branch;
  for (const std::uint64_t hash : context.hashes) json["hashes"].push_back(hash_text(hash));
  if (!result.passed) {
    constexpr std::ptrdiff_t last = 20;
    const std::vector<Transition>& all = context.log.transitions();
    json["transitions"] = Json::array();
    const auto from = all.end() - std::min(last, static_cast<std::ptrdiff_t>(all.size()));
    for (auto it = from; it != all.end(); ++it) json["transitions"].push_back(transition_line(*it));
    json["evidence"] = evidence_json(context.evidence);
  }
  return json_text(json);
}

}  // namespace kadans
