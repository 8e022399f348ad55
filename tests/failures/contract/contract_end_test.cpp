// Rows of the failure contract for how a run begins and ends: the program itself, with plug-ins that hang, and with a
// CPU that somebody else keeps.
#include <csignal>
#include <memory>
#include <string>

#include <doctest/doctest.h>
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/program.h"
#include "failures/live_program.h"
#include "realtime/machine/machine.h"
#include "telemetry/mcap/mcap_reader.h"

namespace contract_end_test {

using namespace kadans;
using namespace kadans::failures;
using doctest::description;

namespace {

namespace fs = std::filesystem;

// A project whose TULip is held by a control object that hangs after 0.1 s.
fs::path hanging_project(const std::string& plugin) {
  const fs::path project = program::project_copy(plugin);
  const fs::path robot = project / "config/tulip/robot.json";
  const std::string file = KADANS_BINARY_DIR "/tests/plugins/" + plugin + "_plugin.so";
  REQUIRE(program::edit(robot, "\"name\": \"tulip\",", "\"name\": \"tulip\", \"plugins\": [\"" + file + "\"],"));
  REQUIRE(program::edit(robot, "\"objects\": [",
                        R"("objects": [{ "name": "stuck", "type": "hostile", "joints": ["l_knee"] },)"));
  REQUIRE(program::edit(robot, "\"sets\": {", R"("sets": { "stuck": { "objects": ["stuck"] },)"));
  REQUIRE(program::edit(robot, "\"initial_set\": \"posture\"", "\"initial_set\": \"stuck\""));
  return project;
}

bool is_whole(const fs::path& record) {
  McapReader reader(record.string());
  for (McapMessage message; reader.next(message);) {
  }
  return reader.complete();
}

// Somebody else's program in real time that leaves a CPU to nobody.
class Hog {
 public:
  explicit Hog(std::size_t cpu) : pid_(fork()) {
    if (pid_ != 0) return;
    cpu_set_t cpus;
    CPU_ZERO(&cpus);
    CPU_SET(cpu, &cpus);
    const sched_param parameter{.sched_priority = 97};
    (void)sched_setaffinity(0, sizeof cpus, &cpus);
    (void)sched_setscheduler(0, SCHED_FIFO, &parameter);
    for (;;) {
    }
  }
  ~Hog() {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Hog(const Hog&) = delete;
  Hog& operator=(const Hog&) = delete;

 private:
  pid_t pid_;
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("a signal ends the run all the same: the record is whole, the exit says which thread hangs" *
          description("a thread of the engines hangs")) {
  for (const std::string clock : {"--soft --sleep-only", "--threads-on-virtual-time"}) {
    for (const std::string plugin : {"hanging_update", "hanging_step"}) {
      CAPTURE(clock);
      CAPTURE(plugin);
      const fs::path project = hanging_project(plugin);
      LiveProgram run(project, "config/tulip/robot.json --plant ideal --no-ctl " + clock);
      REQUIRE(run.says("hangs now"));
      run.signal(SIGTERM);
      (void)run.end();
      CHECK(run.exit_code() == 1);
      const std::string thread = plugin == "hanging_step" ? "control" : "behaviors";
      CHECK_MESSAGE(run.heard("the thread '" + thread + "' hangs") == 1, run.heard());
      CHECK(is_whole(project / "out.mcap"));
    }
  }
}

TEST_CASE("it is told which threads wait, and a signal ends the run before anything has begun" *
          description("another program keeps the CPU from a thread at the start")) {
  if (!read_rights("/").priority(97) || sysconf(_SC_NPROCESSORS_ONLN) < 2) return;  // nobody can keep it then
  const fs::path project = program::project_copy("starved_start");
  auto hog = std::make_unique<Hog>(1);
  LiveProgram run(project, "config/tulip/robot.json --plant ideal --no-ctl --cpu 1");
  REQUIRE(run.says("waiting for a CPU: control"));
  run.signal(SIGTERM);
  CHECK(run.says("nothing has begun"));
  CHECK(run.says("hangs; the run ended without it"));
  hog.reset();  // a thread dies on its CPU
  (void)run.end();
  CHECK(run.exit_code() == 1);
}

TEST_CASE("it is below the thread that kills it, so that it keeps no CPU from it" *
          description("the behaviors' process keeps its CPU busy in real time")) {
  if (!read_rights("/").priority(97)) return;
  const fs::path project = program::project_copy("child_priority");
  LiveProgram run(project, "config/tulip/robot.json --plant ideal --no-ctl --soft --behaviors process --play squat");
  REQUIRE(run.says("squat: "));
  sched_param child{};
  REQUIRE(sched_getparam(run.behavior_process(), &child) == 0);
  CHECK(child.sched_priority > 0);
  CHECK(child.sched_priority < 40);
  run.signal(SIGTERM);
  (void)run.end();
}

TEST_SUITE_END();

}  // namespace contract_end_test
