// The rows of the failure contract about what decides over behaviors. They run the whole assembly of TULip, without
// physics.
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace contract_supervisor_test {

using namespace kadans;
using namespace kadans::program;
using doctest::description;
using WhenLost = SupervisorConfig::WhenLost;

namespace {

// Decisions that let the robot squat, and run `code` in each tick from 0.5 s on.
std::string decisions(const std::string& code) {
  return "local k = require \"kadans\"\n"
         "return k.decisions \"decide\" {\n"
         "  initial = \"squat\",\n"
         "  k.state \"squat\" {\n"
         "    enter = function(m) m:replace(\"squat{repeats=100}\") end,\n"
         "    { after = 0.5, to = \"late\" },\n"
         "  },\n"
         "  k.state \"late\" {\n"
         "    endless = true,\n"
         "    during = function(m, s)\n" +
         code +
         "\n    end,\n"
         "  },\n"
         "}\n";
}

struct Play {
  std::filesystem::path project;
  ScenarioConfig scenario;
  RunLog log;
  RunResult result;
  std::unique_ptr<Assembly> robot;

  Play(const char* folder, const std::string& lua, WhenLost when_lost) : project(project_copy(folder)) {
    write(project / "behaviors/tulip/decide.lua", lua);
    scenario = read_scenario_config(project / "config/scenarios/squat.json");
    scenario.plant = "ideal";
    scenario.checks.clear();
    scenario.behaviors = {{.file = project / "behaviors/tulip/stand.lua"}};
    scenario.supervisor = {.given = true,
                           .decisions = {{.file = project / "behaviors/tulip/decide.lua"}},
                           .rate_Hz = 20,
                           .lost_after_s = 0.2,
                           .when_lost = when_lost,
                           .lost_list = {{.file = project / "behaviors/tulip/wave.lua"}}};
  }
  Assembly& made() {
    if (!robot) robot = std::make_unique<Assembly>(scenario, 1, log);
    return *robot;
  }
  void run(double until_s) {
    Checks checks(made().catalog().signals);
    result = run_scenario(made().parts(), until_s, checks, {});
  }
  bool said(const std::string& what) const {
    for (const LogLine& line : log.lines()) {
      if (has(line.text, what)) return true;
    }
    return false;
  }
  // Name of what plays; "": nothing.
  std::string plays() {
    PlayReport report;
    made().host().report(report);
    return report.count == 0 ? "" : report.playing[0].name.data();
  }
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("they end with file:line, what plays goes on, or stops, or another list takes over, as robot.json says" *
          description("the decisions have an error")) {
  constexpr std::array<const char*, 3> left{"squat", "", "wave"};
  for (const WhenLost when_lost : {WhenLost::go_on, WhenLost::stop, WhenLost::play}) {
    CAPTURE(when_lost);
    Play play("contract_decisions_error", decisions("      local nothing = nil\n      nothing.field = 1"), when_lost);
    play.run(0.45);
    CHECK(play.plays() == "squat");
    play.run(0.8);
    CHECK(play.said("behaviors/tulip/decide.lua:12:"));
    CHECK(play.said("nothing decides any more"));
    CHECK(play.plays() == left.at(static_cast<std::size_t>(when_lost)));
    CHECK(play.result.faults.empty());
  }
}

TEST_CASE("stopped within its budget, the control loop and the behaviors show no effect, then as robot.json says" *
          description("the decisions loop or eat memory")) {
  for (const char* code : {"      while true do end", "      local t = {} while true do t[#t + 1] = {} end"}) {
    Play play("contract_decisions_loop", decisions(code), WhenLost::go_on);
    play.run(1);
    CHECK(play.said("behaviors/tulip/decide.lua:11"));
    CHECK(play.result.control_ticks == 1000);
    CHECK(play.result.behavior_ticks == 100);
    CHECK(play.plays() == "squat");
    CHECK(play.result.faults.empty());
  }
}

TEST_CASE("behaviors go on for lost_after_s, then as robot.json says, and when it is back it decides again" *
          description("the supervisor hangs")) {
  Play play("contract_supervisor_hangs",
            decisions("      if s.time_s > 1.4 and not m:plays(\"nod\") then m:replace(\"squat{repeats=100}\") end"),
            WhenLost::play);
  play.scenario.faults = {{.kind = ScenarioFault::Kind::supervisor_silent, .from_s = 0.5, .until_s = 1.2}};
  play.run(0.65);
  CHECK(play.plays() == "squat");
  play.run(0.8);
  CHECK(play.said("nothing decides any more: another list takes over"));
  CHECK(play.plays() == "wave");
  play.run(1.5);
  CHECK(play.said("decides again"));
  CHECK(play.plays() == "squat");
  CHECK_FALSE(play.log.has_errors());
  CHECK(play.result.faults.empty());
}

TEST_CASE("the running version goes on, the error shows file:line, and a version that has ended is replaced" *
          description("a reload of the decisions fails")) {
  Play play("contract_decisions_reload", decisions("      local nothing = 1"), WhenLost::stop);
  play.made().watch_behaviors();
  play.run(0.7);
  write(play.project / "behaviors/tulip/decide.lua", "return k.decisions {");
  play.run(0.9);
  CHECK(play.said("reload refused, the old version goes on: behaviors/tulip/decide.lua:1:"));
  CHECK(play.plays() == "squat");
  CHECK_FALSE(play.log.has_errors());
  Play ended("contract_decisions_anew", decisions("      error(\"enough\")"), WhenLost::stop);
  ended.made().watch_behaviors();
  ended.run(0.8);
  CHECK(ended.plays() == "");
  write(ended.project / "behaviors/tulip/decide.lua", decisions("      local nothing = 1"));
  ended.run(1.2);
  CHECK(ended.said("begins anew"));
  CHECK(ended.said("decides again"));
  CHECK(ended.plays() == "squat");
  Assembly& robot = ended.made();  // its signals are those of the one that decides now
  const SignalId heap = robot.catalog().signals.find("behavior.decide.heap_bytes").value();
  CHECK(robot.control().row()[heap] == robot.supervisor()->decisions()->behavior().status().heap_bytes.load());
}

TEST_CASE("what plays goes on, the decisions hear why, and nothing else changes" *
          description("the decisions ask for what cannot be played")) {
  struct Asked {
    const char *order, *why;
  };
  for (const Asked& asked :
       {Asked{"m:play(\"squat{repeats=-5}\")", "repeats"}, Asked{"m:replace(\"squat\", { gone = 1 })", "gone"},
        Asked{"m:emit(\"whistle\", nil, { to = \"squat\" })", "squat"}}) {
    CAPTURE(asked.order);
    Play play("contract_decisions_refused",
              "local k = require \"kadans\"\n"
              "k.events { whistle = {} }\n"
              "return k.decisions \"decide\" {\n"
              "  initial = \"squat\",\n"
              "  k.state \"squat\" { enter = function(m) m:replace(\"squat{repeats=100}\") end, { after = 0.5, to = "
              "\"ask\" } },\n"
              "  k.state \"ask\" { enter = function(m) " +
                  std::string(asked.order) +
                  " end,\n"
                  "    { on = \"play.refused\", action = function(_, s) k.log.info(s.event.data.why) end, to = "
                  "\"over\" } },\n"
                  "  k.final \"over\" { outcome = \"done\" },\n"
                  "}\n",
              WhenLost::stop);
    play.run(1.5);
    CHECK(play.said("an order of the decisions was refused"));
    CHECK(play.said(asked.why));
    CHECK(play.plays() == "squat");
    CHECK_FALSE(play.log.has_errors());
    CHECK(play.result.faults.empty());
  }
}

TEST_SUITE_END();

}  // namespace contract_supervisor_test
