// Rows of the failure contract for behaviors in a process of their own: hostile programs in its place, in lockstep, and
// the program itself on its threads.
#include <array>
#include <atomic>
#include <cstdlib>
#include <thread>

#include <doctest/doctest.h>
#include <unistd.h>

#include "app/program.h"
#include "engine/bench.h"
#include "failures/live_program.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/random.h"
#include "script/process/behavior_link.h"
#include "script/process/process_host.h"

namespace contract_process_test {

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

class Words final : public BehaviorLog, private LineSink {
 public:
  Words() { add(*this); }
  void tell(const Line& line) override {
    if (line.transition != nullptr) return;
    all.append(line.text).append("\n");
    errors += line.severity == Severity::error ? 1 : 0;
  }
  bool have(const std::string& text) const { return all.find(text) != std::string::npos; }
  std::string all;
  int errors = 0;
};

// A robot at rest whose behaviors are the hostile process.
struct Hostage {
  explicit Hostage(const std::string& what, RestartPolicy::Settings restart = {.deaths_max = 1000, .delay_max_ns = 0},
                   std::int64_t patience_ns = 5'000'000'000) {
    ProcessHost::Settings settings;
    settings.program = KADANS_BINARY_DIR "/tests/hostile_process";
    settings.arguments = {"hostile_process", what, std::to_string(fingerprint_of(robot.catalog))};
    settings.time_stands = true;
    settings.patience_ns = patience_ns;
    settings.restart = restart;
    host.emplace(settings, words);
    host->attach(catalog, {.pose = "safe", .after_s = 0.5, .time_s = 0.5});
    behaviors.emplace(robot.sets, *robot.exchange, &*host);
    lockstep.emplace(robot.settings, robot.plant, robot.control, *behaviors);
  }
  void run(int ms) {
    for (int i = 0; i < ms; ++i) lockstep->step();
  }
  SafetyLevel level() { return robot.exchange->snapshot.newest(1).status.safety.level; }
  double away_rad(double hip_rad, double knee_rad) const {
    return std::max(std::abs(robot.position_rad(0) - hip_rad), std::abs(robot.position_rad(1) - knee_rad));
  }
  double moved_rad() const { return away_rad(0.1, -0.2); }

  struct Posed : bench::Robot {
    Posed() {
      catalog.poses = {{"safe", {{0, 0.5}, {1, 0.5}}}};
      for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
        catalog.objects[catalog.setpoints[id].owner].setpoints.push_back(id);
      }
    }
  };
  Words words;
  Posed robot;
  Catalog catalog = robot.catalog;  // the engine's row of signals is made already
  std::optional<ProcessHost> host;
  std::optional<BehaviorEngine> behaviors;
  std::optional<Lockstep> lockstep;
};

// Kills the behavior process at random moments, so often; then the program is told to stop.
void kill_at_random(const LiveProgram& program, int times, std::uint64_t seed, const std::vector<int>& signals) {
  RandomStream random(seed, "kills");
  pid_t last = -1;
  for (int i = 0; i < times; ++i) {
    const pid_t pid = program.behavior_process(last);
    if (pid < 0) return;
    usleep(static_cast<useconds_t>(random.uniform(0, 60'000)));  // any moment will do
    kill(last = pid, signals[static_cast<std::size_t>(i) % signals.size()]);
  }
}

const char* const squat =
    "config/tulip/robot.json --play 'squat{repeats=100}' --threads-on-virtual-time --behaviors process ";

// To the end of the run, and back through its record.
void check_that_it_stood(LiveProgram& program, int deaths) {
  program.signal(SIGTERM);
  const nlohmann::json result = program.end();
  CAPTURE(program.heard());
  REQUIRE(result.is_object());
  CHECK(program.exit_code() == 0);
  CHECK(result["ended"] == "told to stop");
  const auto& process = result["behavior_process"];
  CHECK(process["down"] == false);
  CHECK(process["deaths"] >= deaths);
  CHECK(process["takeovers"] > 0);
  CHECK(result["commands"]["refused"] == 0);
  CHECK(result["threads"]["control"]["missed"] == 0);
  CHECK(program.heard("settle -> squat") == 1);
  const double end_s = result["duration_s"];
  CHECK(program.recorded("plant.base.height_m", 0.1, end_s).min > 0.6);
  CHECK(program.recorded("plant.base.tilt_rad", 0, end_s).max < 0.1);
  CHECK(program.recorded("behavior.squat.state", 0, end_s).max >= 2);
  CHECK(program.recorded("safety.faults", 0, end_s).max == 0);
}

// TULip squats, its process is killed, it squats on; stands all the time, in every run.
void kill_while_squatting(const std::string& name, int times, std::uint64_t seed, const std::vector<int>& signals,
                          const std::string& options = "") {
  LiveProgram program(program::project_copy(name), squat + options);
  REQUIRE(program.says("settle -> squat"));
  std::thread killer([&] {
    kill_at_random(program, times, seed, signals);
    (void)program.behavior_process();
  });
  killer.join();
  // It goes on in the state that it was in, and through it.
  CHECK(program.says("squat -> rest"));
  check_that_it_stood(program, times);
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("TULip stands, holds its set-points, and squats on in the state in which it was" *
          description("the behaviors' process is killed or crashes, at any moment of a squat")) {
  // Killed, as by a crash of the interpreter, as by an assertion.
  kill_while_squatting("process_killed", 6, 1, {SIGKILL, SIGSEGV, SIGABRT});
}

TEST_CASE("it is killed when its patience is over, and replaced" *
          description("the behaviors' process hangs or is stopped")) {
  LiveProgram program(program::project_copy("process_stopped"), std::string(squat) + "--behaviors-patience 0.3");
  REQUIRE(program.says("settle -> squat"));
  for (int i = 0; i < 2; ++i) {
    program.signal_behavior_process(SIGSTOP);
    REQUIRE(program.says("the behaviors' process died: it did not answer"));
    REQUIRE(program.says("the behaviors' process goes on"));
  }
  REQUIRE(program.says("squat -> rest"));
  check_that_it_stood(program, 2);
  Hostage hostage("mute", {.deaths_max = 1000, .delay_max_ns = 0}, 20'000'000);
  hostage.run(100);
  CHECK(hostage.words.have("it did not answer"));
  CHECK(hostage.host->deaths() >= 5);
  CHECK(hostage.level() == SafetyLevel::normal);
}

TEST_CASE("it dies alone, the robot holds, the next one has memory again" *
          description("the behaviors' process runs out of memory")) {
  Hostage hostage("hungry");
  hostage.run(60);
  CHECK(hostage.host->deaths() >= 2);
  CHECK_FALSE(hostage.words.have("it did not answer"));
  CHECK(hostage.moved_rad() < 0.01);
  CHECK(hostage.level() == SafetyLevel::normal);
}

TEST_CASE("nothing of it harms the runtime: what breaks the rules kills its process, a wrong command is refused whole" *
          description("the behaviors' process scribbles over all shared memory, or lies")) {
  for (const char* what : {"scribble", "liar"}) {
    CAPTURE(what);
    Hostage hostage(what);
    hostage.run(400);
    CHECK(hostage.words.have("it wrote rubbish"));
    CHECK(hostage.host->deaths() >= 10);
    CHECK(hostage.robot.control.ticks() == 400);
    CHECK(hostage.robot.plant.truth().joint_count == 2);
    CHECK(std::isfinite(hostage.robot.position_rad(0)));
  }
  CHECK_THROWS_WITH_AS(Hostage("nameless"), doctest::Contains("it tells no names"), InputError);
}

TEST_CASE("it stays down and says so, the robot holds, then is in its safe posture" *
          description("the behaviors' process dies again and again")) {
  Hostage hostage("quit", {.deaths_max = 4});
  hostage.run(300);
  CHECK(hostage.host->deaths() == 3);
  CHECK(hostage.words.errors == 0);
  CHECK(hostage.moved_rad() < 0.01);
  hostage.run(100);
  CHECK(hostage.host->down());
  CHECK(hostage.words.have("stays down: exit code 3, 4 times in a row"));
  hostage.run(2000);
  CHECK(hostage.away_rad(0.5, 0.5) < 0.02);
  CHECK(hostage.host->deaths() == 4);
  CHECK(hostage.level() == SafetyLevel::normal);
}

TEST_CASE("it is told when that comes up, the next one is not started, the robot goes to its safe posture" *
          description("the behaviors' process dies and its state could not be kept")) {
  const auto project = program::project_copy("process_unkept");
  REQUIRE(program::edit(project / "behaviors/tulip/squat.lua", "vars     = { done = 0 }",
                        "vars = { done = 0, f = { 1 } }"));
  REQUIRE(program::edit(project / "behaviors/tulip/squat.lua", "m.posture:set_gains(\"stiff\")",
                        "m.vars.f = { print } m.posture:set_gains(\"stiff\")"));
  LiveProgram program(project, std::string(squat) + "--plant ideal");
  REQUIRE(program.says("would be lost with this process: squat: vars hold a function"));
  REQUIRE(program.says("settle -> squat"));
  program.signal_behavior_process(SIGKILL);
  CHECK(program.says("stays down: signal 9 (Killed), and its state could not be kept"));
  program.signal(SIGTERM);
  CHECK(program.end()["behavior_process"]["down"] == true);
  CHECK(program.exit_code() == 1);
}

TEST_SUITE_END();

TEST_CASE("TULip stands through a thousand kills of the behaviors' process") {
  const bool soak = std::getenv("KADANS_SOAK") != nullptr;
  for (std::uint64_t seed = 10; seed < (soak ? 20 : 0); ++seed) {
    CAPTURE(seed);
    kill_while_squatting("process_soak", 100, seed, {SIGKILL}, "--behaviors-deaths 1000");
  }
}

}  // namespace contract_process_test
