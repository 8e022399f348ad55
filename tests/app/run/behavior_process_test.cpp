// `kadans run --behaviors process` as a person would call it; what befalls the process is in tests/failures.
#include <cstdlib>
#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace behavior_process_test {

using namespace kadans::program;
using Json = nlohmann::json;

namespace {

const std::string on_virtual_time = " --threads-on-virtual-time --behaviors process ";

Json result_of(const std::string& out) { return Json::parse(out); }

// The lines of the behaviors until the robot is left, without the times.
std::string said(const std::string& err) {
  std::istringstream lines(err);
  std::string all;
  for (std::string line; std::getline(lines, line);) {
    if (has(line, "supervisor: stop")) break;
    if (has(line, " s  ")) all += line.substr(line.find(" s  ") + 4) + "\n";
  }
  return all;
}

}  // namespace

TEST_CASE("run with a behavior process squats as with a thread: the same transitions, commands and records") {
  const auto project = project_copy("process_squat");
  const std::string squat = "run config/tulip/robot.json --play squat --duration 2.7 -v --json --record r.mcap";
  const Outcome threads = run(squat + " --threads-on-virtual-time", project);
  const Outcome process = run(squat + on_virtual_time, project);
  CHECK_MESSAGE(process.exit_code == 0, process.err);
  const Json result = result_of(process.out), other = result_of(threads.out);
  CHECK(result["behavior_process"]["deaths"] == 0);
  CHECK(result["commands"] == other["commands"]);
  CHECK(result["commands"]["refused"] == 0);
  CHECK(result["threads"]["control"]["missed"] == 0);
  CHECK(result["record"]["rows"] == result["control_ticks"]);
  CHECK(result["safety_level"] == "off");
  CHECK(said(process.err) == said(threads.err));
  CHECK(has(said(process.err), "settle -> squat"));
}

TEST_CASE("a behavior process tells all active states, as signals and by their paths") {
  const auto project = project_copy("process_active");
  write(project / "behaviors/tulip/two.lua",
        "local k = require 'kadans'\nreturn k.behavior 'two' { controls = 'posture', k.parallel 'both' {\n"
        "  k.region 'a' { initial = 'x', k.state 'x' { { after = 0.3, to = 'y' } }, k.state 'y' { endless = true } },\n"
        "  k.region 'b' { k.state 'z' { endless = true } } } }\n");
  const std::string two = "run config/tulip/robot.json --plant ideal --play two --duration 0.6 --record ";
  REQUIRE(run(two + "process.mcap" + on_virtual_time, project).exit_code == 0);
  REQUIRE(run(two + "thread.mcap --threads-on-virtual-time", project).exit_code == 0);
  const auto told = [&](const std::string& record) {
    return run("log cat " + record + " --topic active", project).out;
  };
  CHECK(has(told("process.mcap"), R"("states":["both.a.y","both.b.z"])"));
  for (const char* record : {"process.mcap", "thread.mcap"}) {  // both.a.x is the third state, both.b.z the last
    const std::string rows = run("log csv " + std::string(record) + " 'behavior.two.region.*'", project).out;
    CHECK(has(rows, "time_s,behavior.two.region.both.a,behavior.two.region.both.b\n"));
    CHECK(has(rows, ",3,6\n"));
    CHECK(has(rows, ",4,6\n"));
  }
}

TEST_CASE(
    "run with a behavior process ends cleanly on SIGTERM: behaviors leave, the robot is off, no process is left") {
  const auto project = project_copy("process_term");
  // Waits for the first transition, then sends the signal to all of the group, as a service manager does.
  write(project / "term.sh",
        "mkfifo told\n"
        "setsid $1 run config/tulip/robot.json --plant ideal --play squat" +
            on_virtual_time +
            "-v --json >out 2>told &\n"
            "exec 3<told; read -r line <&3; kill -TERM -$!; cat <&3 >err; wait $!\n");
  const std::string program = (std::filesystem::path(KADANS_BINARY_DIR) / "kadans").string();
  const int status = std::system(("cd '" + project.string() + "' && sh term.sh '" + program + "'").c_str());
  CHECK(status == 0);
  const Json result = result_of(read(project / "out"));
  CHECK(result["ended"] == "told to stop");
  CHECK(result["safety_level"] == "off");
  CHECK(result["behavior_process"]["deaths"] == 0);
  CHECK(has(read(project / "err"), "supervisor: stop"));
}

TEST_CASE("a reflex that a behavior process arms acts as one of a thread") {
  const auto project = project_copy("process_reflex");
  write(project / "behaviors/tulip/reflex.lua", R"(local k = require "kadans"
return k.behavior "reflex" {
  controls = "posture", initial = "bend",
  k.state "bend" {
    enter = function(m)
      m:on("joint.l_knee.position_rad > 0.4", function(c) c.posture:hold() end, { within_s = 5, event = "bent" })
      m.posture:move({ l_knee = 0.8 }, { time_s = 1 })
    end,
    { on = "bent", to = "held" },
  },
  k.state "held" { { after = 0.5, to = "over", action = function(_, s)
    k.log.info("stays at %.3f rad", s.joints.l_knee.position_rad) end } },
  k.final "over" { outcome = "done" },
}
)");
  const std::string play = "run config/tulip/robot.json --plant ideal --play reflex --duration 2 -v ";
  const Outcome threads = run(play + "--threads-on-virtual-time", project);
  const Outcome process = run(play + on_virtual_time, project);
  for (const Outcome& outcome : {threads, process}) {
    CHECK_MESSAGE(has(said(outcome.err), "what bend armed acted in tick "), outcome.err);
    CHECK_MESSAGE(has(said(outcome.err), "stays at 0.4"), outcome.err);
  }
}

// What the ankles' springs lack to bear the body on one foot tells which stiffness was counted with.
TEST_CASE("what the body can reach follows from the parameters as they are now, also in a behavior process") {
  const auto project = project_copy("process_foresight");
  write(project / "behaviors/reaching/judge.lua", R"(local k = require "kadans"
return k.behavior "judge" {
  controls = "body", initial = "ask",
  k.state "ask" {
    run = function(m)
      local function ask()
        local over = { com_m = { nil, 0, m.body:setpoint("com_z_m") - 0.03 } }
        local motion, why, lacks = m.body:move(over, { time_s = 1, contacts = { "left" } })
        k.log.info("judged: %s %s %.0f", tostring(motion), why, lacks)
      end
      m:wait(0.3)
      ask()
      m.body:set_parameter("passive_Nm_per_rad", 1)
      m:wait(0.3)
      ask()
    end,
    { on = "run.done", to = "over" },
  },
  k.final "over" { outcome = "done" },
}
)");
  const std::string play =
      "run config/reaching/robot.json --plant ideal --play behaviors/reaching/judge.lua --duration 1.5 -v ";
  const Outcome threads = run(play + "--threads-on-virtual-time", project);
  const Outcome process = run(play + on_virtual_time, project);
  CHECK_MESSAGE(has(said(threads.err), "judged: nil cannot_stand 52"), threads.err);
  CHECK_MESSAGE(has(said(threads.err), "judged: nil cannot_stand 76"), threads.err);
  CHECK(said(process.err) == said(threads.err));
}

TEST_CASE("run refuses a wrong behavior before anything moves, wherever it would play") {
  const auto project = project_copy("process_wrong");
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "to = \"rest\"", "to = \"rset\""));
  const Outcome outcome = run("run config/tulip/robot.json --play squat --duration 1" + on_virtual_time, project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "behaviors/tulip/squat.lua:45"));
  CHECK(has(outcome.err, "did you mean 'rest'"));
}

TEST_CASE("a script that fails in a behavior process fails as in a thread: that behavior stops, no process dies") {
  const auto project = project_copy("process_error");
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "m.vars.done = m.vars.done + 1", "error('ouch')"));
  const Outcome outcome =
      run("run config/tulip/robot.json --plant ideal --play squat --duration 9 --json" + on_virtual_time, project);
  CHECK(outcome.exit_code == 1);
  CHECK(has(outcome.err, "squat.lua:43: ouch"));
  CHECK(result_of(outcome.out)["behavior_process"]["deaths"] == 0);
}

}  // namespace behavior_process_test
