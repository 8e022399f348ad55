// The rows of the failure contract that begin in a file from outside: scripts, reloads, configurations. They run the
// whole assembly of TULip, without physics.
#include <cmath>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace contract_script_test {

using namespace kadans;
using namespace kadans::program;
using doctest::description;

namespace {

// A behavior that moves to the squat, then runs `code` in the `enter` of its next state.
std::string behavior(const std::string& code) {
  return "local k = require \"kadans\"\n"
         "return k.behavior \"squat\" {\n"
         "  controls = \"posture\", initial = \"move\",\n"
         "  k.state \"move\" {\n"
         "    enter = function(m) m.posture:move(\"squat\", { time_s = 0.3 }) end,\n"
         "    { after = 0.5, to = \"broken\" },\n"
         "  },\n"
         "  k.state \"broken\" {\n"
         "    enter = function(m)\n" +
         code +
         "\n    end,\n"
         "    { after = 100, to = \"over\" },\n"
         "  },\n"
         "  k.final \"over\" { outcome = \"done\" },\n"
         "}\n";
}

struct Play {
  std::filesystem::path project;
  ScenarioConfig scenario;
  RunLog log;
  RunResult result;
  double knee_rad = 0;

  Play(const char* folder, const std::string& lua, const std::string& reload_with = "")
      : project(project_copy(folder)) {
    write(project / "behaviors/tulip/squat.lua", lua);
    scenario = read_scenario_config(project / "config/scenarios/squat.json");
    scenario.plant = "ideal";
    if (!reload_with.empty()) {
      const auto file = project / "behaviors/tulip/next.lua";
      write(file, reload_with);
      scenario.events.push_back(
          {.at_s = 0.2, .order = {.kind = PlayOrder::Kind::reload, .behavior = {"squat", {}}, .file = file}});
    }
  }
  void run(double duration_s) {
    Assembly robot(scenario, 1, log);
    Checks checks(robot.catalog().signals);
    const RunParts parts = robot.parts();
    result = run_scenario(parts, duration_s, checks, {});
    knee_rad = parts.robot.truth().position_rad[robot.robot().model.find_joint("l_knee").value()];
  }
  bool said(const std::string& what) const {
    for (const LogLine& line : log.lines()) {
      if (has(line.text, what)) return true;
    }
    return false;
  }
};

constexpr double squat_knee_rad = 1.2636, stand_knee_rad = 0.3;

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("that behavior stops with file:line and a traceback, the set holds its set-points, then the safe posture" *
          description("a script errors")) {
  Play play("contract_error", behavior("      local nothing = nil\n      nothing.field = 1"));
  play.run(0.7);
  CHECK(play.said("behaviors/tulip/squat.lua:11:"));
  CHECK(play.said("stack traceback"));
  CHECK(play.knee_rad == doctest::Approx(squat_knee_rad).epsilon(0.02));
  Play later("contract_error_later", behavior("      error(\"enough\")"));
  later.run(4);
  CHECK(later.knee_rad == doctest::Approx(stand_knee_rad).epsilon(0.05));
  CHECK(later.result.faults.empty());
}

TEST_CASE("stopped within its budget, the control loop shows no effect" *
          description("a script loops or eats memory")) {
  for (const char* code : {"      while true do end", "      local t = {} while true do t[#t + 1] = {} end",
                           "      while true do pcall(function() while true do end end) end"}) {
    Play play("contract_loop", behavior(code));
    play.run(0.7);
    CHECK(play.log.has_errors());
    CHECK(play.said("behaviors/tulip/squat.lua:10"));
    CHECK(play.result.control_ticks == 700);
    CHECK(play.result.faults.empty());
    CHECK(play.knee_rad == doctest::Approx(squat_knee_rad).epsilon(0.02));
  }
}

TEST_CASE("ended by the wall clock after engine.behavior_time_max_s, with its line, and the run goes on" *
          description("a script takes long in what instructions do not count, such as comparing long strings")) {
  const auto project = project_copy("contract_time");
  write(project / "behaviors/tulip/squat.lua",
        behavior("      local a, b = (\"x\"):rep(65000) .. 1, (\"x\"):rep(65000) .. 2\n"
                 "      for i = 1, 20000 do local less = pcall(function() return a < b end) end"));
  for (const std::string where : {"thread", "process"}) {
    CAPTURE(where);
    const Outcome outcome =
        run("run config/tulip/robot.json --plant ideal --play squat --soft --duration 2 --behaviors " + where, project);
    CHECK_MESSAGE(has(outcome.err, "behaviors/tulip/squat.lua:"), outcome.err);  // line 11, unless the machine is busy
    CHECK_MESSAGE(has(outcome.err, "time budget exceeded: more than 5.000 ms of wall-clock time in one tick"),
                  outcome.err);
    CHECK(has(outcome.out, "duration over after 2.000 s"));
    CHECK(outcome.exit_code == 1);
  }
}

TEST_CASE("the running version goes on, the error shows file:line" * description("a reload fails")) {
  const std::string good = behavior("      local nothing = 1");
  for (const std::string& bad :
       {std::string("return k.behavior {"), behavior("      local x = = 1"),
        std::string("local k = require \"kadans\"\nreturn k.behavior \"squat\" { initial = \"gone\" }\n")}) {
    Play play("contract_reload", good, bad);
    play.run(0.7);
    CHECK_FALSE(play.log.has_errors());
    CHECK(play.said("next.lua:"));
    CHECK(play.knee_rad == doctest::Approx(squat_knee_rad).epsilon(0.02));  // its motion was not disturbed
  }
}

TEST_CASE("refused before anything moves: file:line:column, what is wrong, what was meant" *
          description("a file from outside is wrong (URDF, JSON, Lua)")) {
  struct Wrong {
    const char *file, *from, *to, *message;
  };
  const Wrong wrongs[] = {
      {"models/tulip/tulip.urdf", "mass value=\"6.0\"", "mass value=\"-6.0\"", "models/tulip/tulip.urdf:"},
      {"config/tulip/robot.json", "\"self_collision\"", "\"self_colision\"", "did you mean 'self_collision'?"},
      {"config/scenarios/squat.json", "\"bullet\"", "\"bulet\"", "did you mean 'bullet'?"},
      {"behaviors/tulip/squat.lua", "to = \"rest\"", "to = \"rset\"", "did you mean 'rest'?"}};
  for (const Wrong& wrong : wrongs) {
    CAPTURE(wrong.file);
    const auto project = project_copy("contract_file");
    REQUIRE(edit(project / wrong.file, wrong.from, wrong.to));
    std::string said;
    try {
      const ScenarioConfig scenario = read_scenario_config(project / "config/scenarios/squat.json");
      RunLog log;
      const Assembly robot(scenario, 1, log);
    } catch (const InputError& error) {
      said = error.what();
    }
    CHECK_MESSAGE(has(said, wrong.message), said);
  }
}

TEST_SUITE_END();

}  // namespace contract_script_test
