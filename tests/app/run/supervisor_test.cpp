// A supervisor in whole runs: in lockstep, on threads, several robots that talk, and what records hold of it.
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/assembly/assembly.h"
#include "app/program.h"

namespace supervisor_test {

using namespace kadans;
using namespace kadans::program;
namespace fs = std::filesystem;

namespace {

const std::string project_scenarios = KADANS_SOURCE_DIR "/config/scenarios/";

// TULip whose robot.json has a supervisor that waves, then squats, then knows that it is done.
const char* const decisions = R"(local k = require "kadans"
return k.decisions "decide" {
  initial = "wave",
  k.state "wave" {
    enter = function(m) m:replace("wave") end,
    { on = "play.done", to = "squat" },
  },
  k.state "squat" {
    enter = function(m) m:replace("squat", { repeats = 1, depth_m = 0.05 }) end,
    { on = "play.done", to = "over" },
  },
  k.final "over" { outcome = "done" },
}
)";

fs::path supervised_project(const std::string& name) {
  fs::path project = project_copy(name);
  write(project / "behaviors/tulip/decide.lua", decisions);
  write(project / "config/tulip/decides.json",
        R"({ "based_on": "config/tulip/robot.json", "supervisor": { "decisions": "decide",
  "world": { "ball": { "place": "point" } }, "when_lost": "stand" } })");
  return project;
}

RunResult played(const ScenarioConfig& scenario, double duration_s, RunLog& log) {
  Assembly robot(scenario, 3, log);
  Checks none(robot.catalog().signals, {});
  return run_scenario(robot.parts(), duration_s, none, {});
}

}  // namespace

TEST_CASE("A simulation with a supervisor is the same bit for bit when it is run again, decisions included") {
  const ScenarioConfig scenario = read_scenario_config(project_scenarios + "fetch.json");
  RunLog first, second;
  const RunResult a = played(scenario, 6, first), b = played(scenario, 6, second);
  CHECK(a.state_hash == b.state_hash);
  REQUIRE(first.transitions().size() == second.transitions().size());
  CHECK(first.transitions().size() >= 2);
  for (std::size_t i = 0; i < first.transitions().size(); ++i) {
    CHECK(first.transitions()[i].time_ns == second.transitions()[i].time_ns);
    CHECK(first.transitions()[i].to == second.transitions()[i].to);
  }
}

TEST_CASE("A list that takes over is checked before anything plays") {
  const fs::path project = supervised_project("lost_list_checked");
  write(project / "config/tulip/decides.json", R"({ "based_on": "config/tulip/robot.json",
  "supervisor": { "decisions": "decide", "when_lost": "squat{depth_m=9}" } })");
  ScenarioConfig scenario = read_scenario_config((project / "config/scenarios/squat.json").string());
  scenario.robot = (project / "config/tulip/decides.json").string();
  RunLog log;
  CHECK_THROWS_WITH_AS(Assembly(scenario, 3, log), doctest::Contains("decides.json:2:61: "), InputError);
}

TEST_CASE("What perception says is put where the robot was: the ball stays within its noise while TULip walks") {
  ScenarioConfig scenario = read_scenario_config(project_scenarios + "fetch.json");
  ScenarioPerception& seen = scenario.perception.at(0);
  seen.settings.distance_noise = seen.settings.bearing_noise_rad = seen.settings.missed = seen.imagined = 0;
  seen.settings.latency_s = 0.3;
  RunLog log;
  Assembly robot(scenario, 3, log);
  Checks checks(robot.catalog().signals,
                {{.name = "where it is, m",
                  .kind = CheckKind::always,
                  .that = "not (seen.ball.confidence > 0) or "
                          "abs(sqrt(seen.ball.x_m^2 + seen.ball.y_m^2) - sqrt((world.ball.x_m - plant.base.x_m)^2 + "
                          "(world.ball.y_m - plant.base.y_m)^2)) < 0.05",
                  .from_s = 4}});
  const RunResult result = run_scenario(robot.parts(), 9, checks, {});
  CHECK_MESSAGE(result.checks.at(0).passed, result.checks.at(0).at_s);
}

TEST_CASE("kadans run plays what the decisions want, on threads, and its record is repeated bit for bit") {
  const fs::path project = supervised_project("supervised_run");
  const Outcome made =
      run("run config/tulip/decides.json --plant bullet --duration 9 --threads-on-virtual-time --record run.mcap "
          "--flight 0 -v",
          project);
  REQUIRE_MESSAGE(made.exit_code == 0, made.err);
  CHECK_MESSAGE(has(made.err, "decide: wave -> squat"), made.err);
  CHECK_MESSAGE(!has(made.err, "decide: squat -> over"), made.err);  // the run's end is nothing to decide about
  const Outcome outcome = run("replay run.mcap --json", project);
  CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
  CHECK(nlohmann::json::parse(outcome.out)["same"] == true);
  CHECK_MESSAGE(has(outcome.out, " ticks of the decisions"), outcome.out);
}

namespace {

void decide_again(const char* how) {
  CAPTURE(how);
  const fs::path project = supervised_project("repeated_decisions");
  write(project / "behaviors/tulip/decide.lua", R"(local k = require "kadans"
local P = k.params { depth_m = { 0.05, min = 0, max = 0.1, unit = "m", doc = "how deep" } }
return k.decisions "decide" {
  vars = { seen = 0 },
  initial = "wave",
  k.state "wave" {
    enter = function(m) m:replace("wave") end,
    { on = "play.done", to = "squat" },
  },
  k.state "squat" {
    enter = function(m) m:replace("squat", { repeats = 1, depth_m = P.depth_m }) end,
    { on = "play.done", to = "over" },
  },
  k.final "over" { outcome = "done" },
}
)");
  Running robot(
      project,
      "run config/tulip/decides.json --plant ideal --duration 1000 --threads-on-virtual-time --record run.mcap "
      "--flight 0 --ctl ctl -v " +
          std::string(how) + " 2>&1");
  REQUIRE(robot.says("decide: "));
  CHECK(edit(project / "behaviors/tulip/decide.lua", "return k.decisions", "-- again\nreturn k.decisions"));
  for (const char* order : {"why decide", "reload decide"})
    (void)run(std::string("ctl --socket ctl ") + order, project);
  REQUIRE(robot.says("squat: settle -> squat"));
  robot.end(SIGTERM);
  const Outcome same = run("replay run.mcap", project);
  CHECK_MESSAGE(same.exit_code == 0, (same.out + same.err));
  CHECK_MESSAGE(has(same.out, " ticks of the decisions"), same.out);
  REQUIRE(edit(project / "behaviors/tulip/decide.lua", "depth_m = P.depth_m", "depth_m = 0.06"));
  const Outcome other = run("replay run.mcap --with behaviors/tulip/decide.lua", project);
  CHECK_MESSAGE(has(other.out,
                    "of the decisions: they ask for replace squat{\"depth_m\":0.06,\"repeats\":1.0}, recorded was "
                    "replace squat{\"depth_m\":0.05,\"repeats\":1.0}"),
                (other.out + other.err));
  check_damaged(project / "run.mcap");
}

}  // namespace

TEST_CASE("Decisions of a run are repeated from its record, and what they ask for otherwise is told with its time") {
  decide_again("");
}

TEST_CASE("Decisions in a process of their own are repeated, too") { decide_again("--decisions process"); }

TEST_CASE("A simulation with decisions is repeated from its record alone, which holds what they may play") {
  const fs::path folder = fresh_folder("supervised_record");
  REQUIRE(run("sim " + project_scenarios + "fetch.json --duration 3.5 --record fetch.mcap", folder).exit_code <= 1);
  const Outcome outcome = run("replay fetch.mcap --from-record --json", folder);
  CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
  CHECK(nlohmann::json::parse(outcome.out)["same"] == true);
}

TEST_CASE("Decisions play the same in a thread and in a process, over behaviors in a thread and in a process") {
  const fs::path project = supervised_project("supervised_process");
  for (const char* how : {"--behaviors process", "--behaviors process --decisions thread", "--decisions process"}) {
    CAPTURE(how);
    const Outcome made = run("run config/tulip/decides.json --plant ideal --duration 8.5 --threads-on-virtual-time " +
                                 std::string(how) + " --record run.mcap --flight 0 -v --json",
                             project);
    REQUIRE_MESSAGE(made.exit_code == 0, made.err);
    CHECK_MESSAGE(has(made.err, "decide: wave -> squat"), made.err);  // it heard how the wave ended
    CHECK_MESSAGE(has(made.err, "squat: settle -> squat"), made.err);
    const auto result = nlohmann::json::parse(last_line(made.out));
    CHECK(result.contains("decision_process") == !has(how, "--decisions thread"));
    CHECK(result.contains("behavior_process") == has(how, "--behaviors process"));
    const Outcome outcome = run("replay run.mcap --json", project);
    CHECK_MESSAGE(outcome.exit_code == 0, (outcome.out + outcome.err));
    CHECK(nlohmann::json::parse(outcome.out)["same"] == true);
    CHECK_MESSAGE(has(outcome.out, " ticks of the decisions"), outcome.out);
  }
}

TEST_CASE("Decisions in a process of their own are refused with their place when they are wrong") {
  const fs::path project = supervised_project("supervised_process_wrong");
  REQUIRE(edit(project / "behaviors/tulip/decide.lua", "to = \"squat\"", "to = \"sqat\""));
  const Outcome outcome =
      run("run config/tulip/decides.json --plant ideal --soft --duration 1 --decisions process", project);
  CHECK(outcome.exit_code == 2);
  CHECK_MESSAGE(has(outcome.err, "behaviors/tulip/decide.lua:6:"), outcome.err);
}

TEST_CASE("A k.decisions is no behavior, and a behavior decides nothing: both are refused with their places") {
  const fs::path project = supervised_project("supervised_wrong");
  const Outcome list = run("run config/tulip/robot.json --plant ideal --soft --duration 1 --play decide", project);
  CHECK(list.exit_code == 2);
  CHECK_MESSAGE(has(list.err, "--play:1:1: 'decide' is a k.decisions"), list.err);
  CHECK(edit(project / "config/tulip/decides.json", "\"decide\"", "\"squat\""));
  const Outcome decides = run("run config/tulip/decides.json --plant ideal --soft --duration 1", project);
  CHECK(decides.exit_code == 2);
  CHECK_MESSAGE(has(decides.err, "'squat' is a k.behavior; what decides returns k.decisions"), decides.err);
}

TEST_CASE("Two robots of a scenario send each other messages over its network, which loses some of them") {
  const fs::path project = project_copy("supervised_pair");
  write(project / "behaviors/tulip/talk.lua", R"(local k = require "kadans"
k.events { ["robot.hello"] = { number = { "", min = 0, max = 1000 }, from = { k.text, optional = true } } }
return k.decisions "talk" {
  vars = { said = 0 },
  initial = "talk",
  k.state "talk" {
    endless = true,
    during = function(m)
      m.vars.said = m.vars.said + 1
      m:send("robot.hello", { number = m.vars.said })
    end,
    { on = "robot.hello", action = function(_, s) k.log.info("%s says %d", s.event.data.from, s.event.data.number) end },
  },
}
)");
  ScenarioConfig scenario = read_scenario_config(project / "config/scenarios/squat.json");
  scenario.plant = "bullet";
  scenario.behaviors.clear();
  scenario.network.lost = 0.5;
  scenario.supervisor = {.given = true,
                         .decisions = {{.file = project / "behaviors/tulip/talk.lua"}},
                         .messages = {.name = "first", .peers = {"left"}}};
  ScenarioConfig left = scenario;
  left.name = "left";
  left.set = {{.key = "start.y_m", .value = 2}};
  left.supervisor.messages = {.name = "left", .peers = {"first"}, .messages_per_minute = 10};
  scenario.robots = {left};
  RunLog log;
  const RunResult result = played(scenario, 2, log);
  CHECK(result.error.empty());
  int by_first = 0, by_left = 0;
  for (const LogLine& line : log.lines()) {
    by_left += line.behavior == "talk" && has(line.text, "left says") ? 1 : 0;
    by_first += line.behavior == "left.talk" && has(line.text, "first says") ? 1 : 0;
  }
  CHECK(by_first >= 12);  // of 40
  CHECK(by_first <= 28);
  CHECK(by_left >= 2);  // of 10, its budget
  CHECK(by_left <= 8);
}

}  // namespace supervisor_test
