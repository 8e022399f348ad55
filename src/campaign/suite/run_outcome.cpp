#include "run_outcome.h"

#include <array>
#include <csignal>
#include <cstring>
#include <limits>

#include <nlohmann/json.hpp>

#include "config/json/foreign_json.h"

namespace kadans {
namespace {

using Json = nlohmann::ordered_json;

// A number that is not finite is null in JSON.
double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

CheckResult check_of(const Json& json) {
  return {.name = json.at("name"),
          .passed = json.at("passed"),
          .value = number(json.at("value")),
          .at_s = number(json.at("at_s")),
          .note = json.value("note", ""),
          .wanted = json.value("wanted", "")};
}

EvidenceTrace trace_of(const Json& json) {
  EvidenceTrace trace{.check = json.at("check"),
                      .signal = json.at("signal"),
                      .unit = json.at("unit"),
                      .from_s = number(json.at("from_s")),
                      .to_s = number(json.at("to_s"))};
  for (const Json& value : json.at("values")) trace.values.push_back(number(value));
  return trace;
}

void read_report(const Json& json, RunOutcome& run) {
  run.scenario = json.at("scenario");
  run.seed = json.at("seed");
  run.simulated_s = number(json.at("duration_s"));
  run.state_hash = json.at("state_hash");
  for (const Json& hash : json.value("hashes", Json::array())) run.hashes.push_back(hash);
  for (const Json& check : json.at("checks")) run.checks.push_back(check_of(check));
  for (const Json& trace : json.value("evidence", Json::array())) run.traces.push_back(trace_of(trace));
  for (const Json& line : json.value("transitions", Json::array())) run.transitions.push_back(line);
  for (const Json& line : json.at("errors")) run.errors.push_back(line);
  run.quantities = named_numbers(json, "quantities");
  run.metrics = named_numbers(json, "metrics");
}

// The last lines of what a process said when it broke down.
void add_last_words(const std::string& err, RunOutcome& run) {
  constexpr std::size_t shown = 2000;
  const std::string tail = err.size() > shown ? "..." + err.substr(err.size() - shown) : err;
  if (!tail.empty()) run.errors.push_back(tail.substr(0, tail.find_last_not_of('\n') + 1));
}

RunStatus status_of(const JobOutcome& outcome, bool reported) {
  if (outcome.cancelled) return RunStatus::cancelled;
  if (outcome.timed_out) return RunStatus::timed_out;
  if (outcome.exit_code == 2) return RunStatus::refused;
  if (!reported || outcome.signal != 0) return RunStatus::crashed;
  if (outcome.exit_code == 0) return RunStatus::passed;
  return outcome.exit_code == 1 ? RunStatus::failed : RunStatus::crashed;
}

}  // namespace

const char* name(RunStatus status) noexcept {
  constexpr std::array<const char*, 6> names{"passed", "failed", "refused", "crashed", "timed out", "cancelled"};
  return names.at(static_cast<std::size_t>(status));
}

RunOutcome read_run_outcome(const JobOutcome& outcome) {
  RunOutcome run;
  run.wall_s = outcome.wall_s;
  const std::size_t begin = outcome.out.find('{');
  bool reported = begin != std::string::npos;
  if (reported) {
    try {
      run.json = outcome.out.substr(begin, outcome.out.find_last_not_of(" \n") + 1 - begin);
      read_report(parse_foreign_json(run.json), run);
    } catch (const std::exception& error) {
      reported = false;
      run.errors.push_back(std::string("the run's report cannot be read: ") + error.what());
      run.json.clear();
    }
  }
  run.status = status_of(outcome, reported);
  if (outcome.signal != 0 && !outcome.timed_out && !outcome.cancelled)
    run.errors.push_back("the process was ended by signal " + std::to_string(outcome.signal) + " (" +
                         strsignal(outcome.signal) + ")");
  if (run.status != RunStatus::passed && run.status != RunStatus::failed) add_last_words(outcome.err, run);
  return run;
}

std::vector<QuantityValue> named_numbers(const Json& report, const char* key) {
  std::vector<QuantityValue> all;
  const Json members = report.value(key, Json::object());
  for (const auto& [name, value] : members.items()) all.push_back({name, number(value)});
  return all;
}

std::string run_json(const RunOutcome& run) {
  nlohmann::ordered_json json{{"scenario", run.scenario}, {"seed", run.seed},     {"status", name(run.status)},
                              {"file", run.file},         {"wall_s", run.wall_s}, {"repeat", run.repeat}};
  if (!run.json.empty()) {
    json.update(parse_foreign_json(run.json));
  } else {
    json["errors"] = run.errors;
  }
  return json_text(json);
}

}  // namespace kadans
