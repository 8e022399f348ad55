#include "scenario/report/report.h"

#include <limits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace kadans;

namespace {

struct Subject {
  RunResult result;
  RunLog log;
  RobotModel model;
  std::vector<ReportTrace> traces;

  Subject() {
    model.joints.resize(1);
    model.joints[0].name = "knee";
    result.scenario = "squat";
    result.seed = 7;
    result.checks = {{"height", true, 0.004, 3.5, "", "<= 0.01"},
                     {"tilt", false, std::numeric_limits<double>::quiet_NaN(), 4.25, "never looked at", "never >= 1"}};
    result.duration_s = 20;
    result.realtime_factor = 25;
    result.control_ticks = 20000;
    result.behavior_ticks = 2000;
    result.state_hash = 0x0123456789abcdefU;
    result.tick = {1200, 2000, 50000};
    result.commands_sent = 72;
    for (const Fault& fault :
         {Fault{.code = FaultCode::velocity_limit, .joint = 0, .tick = 1234, .value = 13, .limit = 12},
          Fault{.code = FaultCode::heartbeat_lost, .tick = 2000, .value = 0.2, .limit = 0.1}})
      result.faults.push_back({fault, told(fault, model)});
    log.transition({1'500'000'000, "squat", "stand", "down", "after 1 s"});
    log.message(0, BehaviorLog::Severity::error, "squat", "squat.lua:12: attempt to call a nil value");
  }
  std::string text(const ReportStyle& style) const {
    return text_report({result, log, "squat", "squat.mcap", "kadans sim squat.json --seed 7", traces}, style);
  }
};

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("The JSON report is one line and one object with the promised keys") {
  const Subject subject;
  const std::string text = json_report({.result = subject.result, .log = subject.log, .record = "squat.mcap"});
  CHECK(text.find('\n') == std::string::npos);
  const auto json = nlohmann::json::parse(text);
  CHECK(json["scenario"] == "squat");
  CHECK(json["seed"] == 7);
  CHECK(json["passed"] == false);
  CHECK(json["checks"].size() == 2);
  CHECK(json["checks"][0] ==
        nlohmann::json{{"name", "height"}, {"passed", true}, {"value", 0.004}, {"at_s", 3.5}, {"wanted", "<= 0.01"}});
  CHECK(json["checks"][1]["value"].is_null());
  CHECK(json["duration_s"] == 20);
  CHECK(json["realtime_factor"] == 25);
  CHECK(json["control_ticks"] == 20000);
  CHECK(json["behavior_ticks"] == 2000);
  CHECK(json["state_hash"] == "0123456789abcdef");
  CHECK(json["tick_ns"] == nlohmann::json{{"median", 1200.0}, {"p99", 2000.0}, {"max", 50000.0}});
  CHECK(json["queue"] == nlohmann::json{{"sent", 72}, {"refused", 0}});
  CHECK(json["faults"][0]["code"] == "velocity_limit");
  CHECK(json["faults"][0]["key"] == "safety.velocity_margin");
  CHECK(json["faults"][0]["joint"] == "knee");
  CHECK_FALSE(json["faults"][1].contains("joint"));
  CHECK(json["errors"][0] == "squat.lua:12: attempt to call a nil value");
}

TEST_CASE("The text report tells transitions, checks, errors, faults and the line that repeats the run") {
  Subject subject;
  subject.traces = {{"base height, m", {0.8, 0.7, 0.8}, 20}};
  const std::string text = subject.text({.color = false, .unicode = false, .verbose = false});
  CHECK(has(text, "1.50 s  squat: stand -> down  (after 1 s)"));
  CHECK(has(text, "ok height"));
  CHECK(has(text, "FAILED tilt"));
  CHECK(has(text, "wanted <= 0.01"));
  CHECK(has(text, "wanted never >= 1; never looked at"));
  CHECK(has(text, "error: squat.lua:12"));
  CHECK(has(text, "fault: velocity_limit of knee in tick 1234: 13, limit 12 (safety.velocity_margin)"));
  CHECK(has(text, "kadans sim squat.json --seed 7"));
  CHECK(has(text, "FAILED  1 of 2 checks"));
  CHECK(has(text, "  base height, m\n         0.8 |"));
  CHECK(has(text, "         0.7 |"));
  CHECK(has(text, " 20 s\n"));
  CHECK(text.find('\033') == std::string::npos);
}

TEST_CASE("With -v what was said stands among the transitions, by time") {
  Subject subject;
  subject.log.message(1'000'000'000, BehaviorLog::Severity::info, "squat", "still standing");
  subject.log.message(1'500'000'000, BehaviorLog::Severity::warning, "squat", "on my way");
  subject.log.transition({2'000'000'000, "squat", "down", "stand", "run.done"});
  const std::string text = subject.text({.color = false, .unicode = false, .verbose = true});
  const std::size_t first = text.find("1.00 s  squat: still standing"), second = text.find("squat: stand -> down"),
                    third = text.find("1.50 s  squat: warning: on my way"), last = text.find("squat: down -> stand");
  REQUIRE(last != std::string::npos);
  CHECK(first < second);
  CHECK(second < third);
  CHECK(third < last);
}

TEST_CASE("Colour is there only when asked for") {
  const Subject subject;
  CHECK(has(subject.text({.color = true, .unicode = true, .verbose = false}), "\033[31;1m"));
}
