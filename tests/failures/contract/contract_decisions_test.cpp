// The rows of the failure contract about decisions in a process of their own: hostile programs in its place, in
// lockstep, and the program itself on its threads.
#include <array>
#include <memory>
#include <string>

#include <doctest/doctest.h>
#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/program.h"
#include "failures/live_program.h"
#include "kadans/signal/random.h"
#include "script/process/behavior_link.h"

namespace contract_decisions_test {

using namespace kadans;
using namespace kadans::failures;
using namespace kadans::program;
using doctest::description;

namespace {

// Decisions that let the robot squat, and count their ticks; each tenth tick goes on to the next state. A transition is
// told when its tick counts. A message would be told of a tick that does not count, too. What `run` counts begins anew
// with each process.
const char* const counting = R"(local k = require "kadans"
k.events { ["robot.waits"] = { ticks = { "", min = 0, max = 1000 } } }
local states = { initial = "tens_0", vars = { ticks = 0 } }
for i = 0, 59 do
  states[i + 1] = k.state("tens_" .. i) {
    enter = i == 0 and function(m) m:replace("squat{repeats=100}") end or nil,
    during = function(m) m.vars.ticks = m.vars.ticks + 1 end,
    run = function(m)
      local waited = 0
      while true do
        m:wait(0.01)
        waited = waited + 1
        m:send("robot.waits", { ticks = waited })
      end
    end,
    { when = function(_, m) return m.vars.ticks >= 10 * (i + 1) end, to = "tens_" .. i + 1 },
  }
end
states[61] = k.state "tens_60" { endless = true }
return k.decisions "decide"(states)
)";

std::filesystem::path supervised(const std::string& name, const std::string& when_lost) {
  const std::filesystem::path project = project_copy(name);
  write(project / "behaviors/tulip/decide.lua", counting);
  write(project / "config/tulip/decides.json",
        R"({ "based_on": "config/tulip/robot.json", "supervisor": { "decisions": "decide", "rate_Hz": 100,
  "lost_after_s": 0.2, "when_lost": )" +
            when_lost + " } }");
  return project;
}

// A robot without physics whose decisions are the hostile process; it squats from the beginning.
struct Hostage {
  ScenarioConfig scenario;
  RunLog log{{}, 100'000};
  std::unique_ptr<Assembly> robot;
  RunResult result;

  explicit Hostage(const std::string& what, ProcessHost::Settings settings,
                   SupervisorConfig::WhenLost when_lost = SupervisorConfig::WhenLost::play) {
    const std::filesystem::path project = supervised("hostile_decisions_" + what, "\"go_on\"");
    scenario = read_scenario_config(project / "config/scenarios/squat.json");
    scenario.plant = "ideal";
    scenario.checks.clear();
    scenario.supervisor = {.given = true,
                           .decisions = {{.file = project / "behaviors/tulip/decide.lua"}},
                           .rate_Hz = 20,
                           .lost_after_s = 0.2,
                           .when_lost = when_lost,
                           .lost_list = {{.file = project / "behaviors/tulip/wave.lua"}}};
    RunLog silence;
    const std::uint64_t fingerprint = fingerprint_of(Assembly(scenario, 1, silence).catalog());
    settings.program = KADANS_BINARY_DIR "/tests/hostile_process";
    settings.arguments = {"hostile_process", what, std::to_string(fingerprint)};
    settings.setup.decides = 1;
    Assembly::Outside outside;
    outside.decisions = [settings](BehaviorLog& to, std::int64_t) {
      return std::make_unique<ProcessHost>(settings, to);
    };
    robot = std::make_unique<Assembly>(scenario, 1, log, nullptr, outside);
  }
  void run(double until_s) {
    Checks none(robot->catalog().signals);
    result = run_scenario(robot->parts(), until_s, none, {});
  }
  bool said(const std::string& what) const {
    for (const LogLine& line : log.lines()) {
      if (has(line.text, what)) return true;
    }
    return false;
  }
  std::string plays() const {
    PlayReport report;
    robot->host().report(report);
    return report.count == 0 ? "" : report.playing[0].name.data();
  }
  const ProcessHost& process() const { return *robot->decision_process(); }
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("behaviors go on, the next process decides on in the state in which it was, no tick of it counts twice" *
          description("the decisions' process is killed or crashes, at any moment")) {
  constexpr int kills = 5;
  const std::filesystem::path project = supervised("decisions_killed", "\"go_on\"");
  LiveProgram program(project, "config/tulip/decides.json --threads-on-virtual-time --decisions process");
  RandomStream random(1, "kills");
  for (int i = 0; i < kills; ++i) {
    // Each process has answered ten ticks before it dies: it is replaced at once then. One that dies sooner is replaced
    // later and later, and the eighth of a row is not replaced (RestartPolicy).
    REQUIRE(program.says("decide: tens_"));
    REQUIRE(program.says("decide: tens_"));
    usleep(static_cast<useconds_t>(random.uniform(0, 30'000)));  // any moment will do
    program.signal_decision_process(std::array{SIGKILL, SIGSEGV, SIGABRT}.at(static_cast<std::size_t>(i) % 3));
    REQUIRE(program.says("the decisions' process goes on as "));
  }
  CHECK((program.heard("settle -> squat") == 1 || program.says("settle -> squat")));
  program.signal(SIGTERM);
  const nlohmann::json result = program.end();
  CAPTURE(program.heard());
  REQUIRE(result.is_object());
  CHECK(program.exit_code() == 0);
  CHECK(result["decision_process"]["deaths"] >= kills);
  CHECK(result["decision_process"]["takeovers"] >= kills);
  CHECK(result["decision_process"]["down"] == false);
  CHECK(result["commands"]["refused"] == 0);
  CHECK(program.heard("the decisions' process died: ") >= kills);
  CHECK(program.heard("replace squat") == 1);
  CHECK(program.heard("settle -> squat") == 1);
  for (int tens = 0; tens < 2 * kills; ++tens) {
    CAPTURE(tens);
    CHECK(program.heard("decide: tens_" + std::to_string(tens) + " -> ") == 1);
  }
  CHECK(program.recorded("safety.faults", 0, result["duration_s"]).max == 0);
  // All of them decide the same again from the record, each from what the one before left.
  const program::Outcome replay = program::run("replay out.mcap", project);
  CHECK_MESSAGE(replay.exit_code == 0, (replay.out + replay.err));
  CHECK_MESSAGE(has(replay.out, " ticks of the decisions"), replay.out);
}

TEST_CASE("they stay over, and their last state is told" *
          description("the decisions' process is killed when they are over")) {
  const std::filesystem::path project = supervised("decisions_over", "\"stop\"");
  write(project / "behaviors/tulip/decide.lua", R"(local k = require "kadans"
return k.decisions "decide" {
  initial = "a",
  k.state "a" { enter = function(m) m:replace("squat{repeats=100}") end, { after = 0.3, to = "over" } },
  k.final "over" { outcome = "done" },
}
)");
  LiveProgram program(project, "config/tulip/decides.json --threads-on-virtual-time --decisions process");
  REQUIRE(program.says("decide: a -> over"));
  program.signal_decision_process(SIGKILL);
  REQUIRE(program.says("the decisions' process goes on as "));
  REQUIRE(program.says("squat -> rest"));
  program.signal(SIGTERM);
  const nlohmann::json result = program.end();
  CHECK(program.exit_code() == 0);
  CHECK(program.heard("decide: a -> over") == 1);
  CHECK(program.heard("replace squat") == 1);
  CHECK(program.recorded("behavior.decide.state", 1, result["duration_s"]).min == 2);
}

TEST_CASE("behaviors go on for lost_after_s, then as robot.json says, and it is killed when its patience is over" *
          description("the decisions' process hangs or is stopped")) {
  using WhenLost = SupervisorConfig::WhenLost;
  constexpr std::array<const char*, 3> left{"squat", "", "wave"};
  for (const WhenLost when_lost : {WhenLost::go_on, WhenLost::stop, WhenLost::play}) {
    CAPTURE(when_lost);
    ProcessHost::Settings settings;
    settings.answer_ns = 0;                    // the supervisor's tick does not wait for it
    settings.patience_ns = 3'600'000'000'000;  // it is never killed
    Hostage hostage("mute", settings, when_lost);
    hostage.run(0.15);
    CHECK(hostage.plays() == "squat");
    hostage.run(0.6);
    CHECK(hostage.said("nothing decides any more"));
    CHECK(hostage.plays() == left.at(static_cast<std::size_t>(when_lost)));
    CHECK(hostage.result.control_ticks == 600);
    CHECK(hostage.result.behavior_ticks == 60);
    CHECK(hostage.result.faults.empty());
  }
  ProcessHost::Settings settings;
  settings.time_stands = true;
  settings.patience_ns = 20'000'000;
  settings.restart = {.deaths_max = 1000, .delay_max_ns = 0};
  Hostage hostage("mute", settings);
  hostage.run(0.6);
  CHECK(hostage.said("the decisions' process died: it did not answer; behaviors go on"));
  CHECK(hostage.process().deaths() >= 3);
  CHECK(hostage.plays() == "wave");
}

TEST_CASE("it dies alone, behaviors go on, the next one has memory again" *
          description("the decisions' process runs out of memory")) {
  ProcessHost::Settings settings;
  settings.time_stands = true;
  settings.patience_ns = 5'000'000'000;
  settings.restart = {.deaths_max = 1000, .delay_max_ns = 0};
  Hostage hostage("hungry", settings, SupervisorConfig::WhenLost::go_on);
  hostage.run(0.3);
  CHECK(hostage.process().deaths() >= 2);
  CHECK_FALSE(hostage.said("it did not answer"));
  CHECK(hostage.plays() == "squat");
  CHECK(hostage.result.control_ticks == 300);
  CHECK(hostage.result.faults.empty());
}

TEST_CASE("it is told when that comes up, the next one is not started, then as robot.json says" *
          description("the decisions' process dies and its state could not be kept")) {
  const std::filesystem::path project = supervised("decisions_unkept", "\"stop\"");
  REQUIRE(edit(project / "behaviors/tulip/decide.lua", "vars = { ticks = 0 }", "vars = { ticks = 0, f = {} }"));
  REQUIRE(
      edit(project / "behaviors/tulip/decide.lua", "during = function(m)", "during = function(m) m.vars.f[1] = print"));
  LiveProgram program(project, "config/tulip/decides.json --plant ideal --threads-on-virtual-time --decisions process");
  REQUIRE(program.says("would be lost with this process: vars hold a function"));
  REQUIRE(program.says("settle -> squat"));
  program.signal_decision_process(SIGKILL);
  CHECK(program.says("the decisions' process stays down: signal 9 (Killed), and its state could not be kept"));
  CHECK(program.says("nothing decides any more: what plays is stopped"));
  program.signal(SIGTERM);
  CHECK(program.end()["decision_process"]["down"] == true);
  CHECK(program.exit_code() == 1);
}

TEST_CASE("it stays down and says so, then as robot.json says" *
          description("the decisions' process dies again and again")) {
  ProcessHost::Settings settings;
  settings.time_stands = true;
  settings.restart = {.deaths_max = 4};
  Hostage hostage("quit", settings);
  hostage.run(0.15);
  CHECK(hostage.plays() == "squat");
  hostage.run(2);
  CHECK(hostage.process().down());
  CHECK(hostage.process().deaths() == 4);
  CHECK(hostage.said("the decisions' process stays down: exit code 3, 4 times in a row"));
  CHECK(hostage.plays() == "wave");
  CHECK(hostage.result.control_ticks == 2000);
  CHECK(hostage.result.faults.empty());
}

TEST_CASE("nothing of it harms the runtime or the behaviors: what breaks the rules kills its process" *
          description("the decisions' process scribbles over all shared memory, or lies")) {
  for (const char* what : {"scribble", "liar"}) {
    CAPTURE(what);
    ProcessHost::Settings settings;
    settings.time_stands = true;
    settings.restart = {.deaths_max = 1000, .delay_max_ns = 0};
    Hostage hostage(what, settings, SupervisorConfig::WhenLost::go_on);
    hostage.run(3);
    CHECK(hostage.said("the decisions' process died: it wrote rubbish"));
    CHECK(hostage.process().deaths() >= 10);
    CHECK(hostage.result.control_ticks == 3000);
    CHECK(hostage.result.behavior_ticks == 300);
    CHECK(hostage.result.faults.empty());
    CHECK(hostage.result.commands_refused == 0);
  }
}

TEST_SUITE_END();

}  // namespace contract_decisions_test
