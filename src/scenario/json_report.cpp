#include <cstdio>

#include <nlohmann/json.hpp>

#include "kadans/scenario/report.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

Json fault_json(const Fault& fault, const RobotModel& model) {
  Json json{{"code", name(fault.code)}, {"tick", fault.tick}};
  if (fault.joint != no_joint) json["joint"] = model.joints.at(fault.joint).name;
  json["value"] = fault.value;
  json["limit"] = fault.limit;
  json["key"] = configuration_key(fault.code);
  return json;
}

}  // namespace

std::string json_report(const RunResult& result, const RunLog& log, const RobotModel& model,
                        const std::string& record) {
  Json json{{"scenario", result.scenario}, {"seed", result.seed}, {"passed", result.passed}};
  json["checks"] = Json::array();
  for (const CheckResult& check : result.checks) {
    json["checks"].push_back(
        {{"name", check.name}, {"passed", check.passed}, {"value", check.value}, {"at_s", check.at_s}});
    if (!check.note.empty()) json["checks"].back()["note"] = check.note;
  }
  json["duration_s"] = result.duration_s;
  json["realtime_factor"] = result.realtime_factor;
  json["control_ticks"] = result.control_ticks;
  json["behavior_ticks"] = result.behavior_ticks;
  json["state_hash"] = hex(result.state_hash);
  json["tick_ns"] = {{"median", result.tick.median_ns}, {"p99", result.tick.p99_ns}, {"max", result.tick.max_ns}};
  json["queue"] = {{"sent", result.commands_sent}, {"refused", result.commands_refused}};
  json["faults"] = Json::array();
  for (const Fault& fault : result.faults) json["faults"].push_back(fault_json(fault, model));
  json["errors"] = Json::array();
  if (!result.error.empty()) json["errors"].push_back(result.error);
  for (const LogLine& line : log.lines()) {
    if (line.severity == BehaviorLog::Severity::error) json["errors"].push_back(line.text);
  }
  json["record"] = record;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace kadans
