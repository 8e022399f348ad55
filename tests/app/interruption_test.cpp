// SIGINT and SIGTERM reach a script that would go on: sim, test, behavior test and repl end, whatever it does.
#include <array>
#include <csignal>

#include <doctest/doctest.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/terminal.h"
#include "program.h"

namespace interruption_test {

using namespace kadans;
using namespace kadans::program;

namespace {

// Numbers of 64 kB of digits: the instructions of one tick are enough for ten seconds.
constexpr const char* slow =
    "local k = require \"kadans\"\n"
    "return k.behavior \"squat\" { k.state \"a\" { endless = true, enter = function()\n"
    "  local digits = \"0x\" .. (\"f\"):rep(65000)\n"
    "  while true do pcall(function() return digits + 0 end) end\n"
    "end } }\n";
// The same, which says that it begins.
std::string slow_and_told() {
  std::string text = slow;
  return text.insert(text.find("  local digits"), "  k.log.info('the loop begins')\n");
}
// The same while a file loads, on its line 2.
constexpr const char* slow_to_load =
    "local digits = \"0x\" .. (\"f\"):rep(65000)\n"
    "while true do pcall(function() return digits + 0 end) end\n";
constexpr const char* told_to_end = ":2: interrupted: the program was told to end";

// In a process of its own, since a signal stays noted: 0 when the behavior was stopped for it.
int run_signalled(const ScenarioConfig& scenario, int number) {
  RunLog log;
  Assembly robot(scenario, 1, log);
  Checks checks(robot.catalog().signals);
  catch_interrupts();
  if (std::raise(number) != 0) return 2;
  (void)run_scenario(robot.parts(), 0.1, checks, {});
  for (const LogLine& line : log.lines()) {
    if (has(line.text, "behaviors/tulip/squat.lua:4: interrupted: the program was told to end")) return 0;
  }
  return 1;
}

// Sees when a file is opened.
class Opening {
 public:
  explicit Opening(const std::filesystem::path& file) {
    REQUIRE(inotify_add_watch(events_, file.c_str(), IN_OPEN) >= 0);
  }
  ~Opening() { close(events_); }
  Opening(const Opening&) = delete;
  Opening& operator=(const Opening&) = delete;

  // Waits for it. False: the program said something or ended before.
  bool seen(const Running& program) const {
    std::array<pollfd, 2> watched{
        {{.fd = events_, .events = POLLIN, .revents = 0}, {.fd = program.output(), .events = POLLIN, .revents = 0}}};
    return poll(watched.data(), watched.size(), -1) > 0 && (watched[0].revents & POLLIN) != 0;
  }

 private:
  int events_ = inotify_init1(IN_CLOEXEC);
};

bool any_process_in(const std::filesystem::path& folder) {
  const std::filesystem::path wanted = std::filesystem::canonical(folder);
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::error_code none;
    if (std::filesystem::read_symlink(entry.path() / "cwd", none) == wanted) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a script that would go on for long is stopped by SIGINT and SIGTERM in a simulation") {
  const auto project = project_copy("interruption");
  write(project / "behaviors/tulip/squat.lua", slow);
  ScenarioConfig scenario = read_scenario_config(project / "config/scenarios/squat.json");
  scenario.plant = "ideal";
  for (const int number : {SIGINT, SIGTERM}) {
    const pid_t child = fork();
    if (child == 0) _exit(run_signalled(scenario, number));
    int status = -1;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 0);
  }
}

TEST_CASE("sim ends with 130 when a signal comes while a script works, and tells the line") {
  const auto project = project_copy("interrupted_sim");
  write(project / "behaviors/tulip/squat.lua", slow_and_told());
  for (const int number : {SIGINT, SIGTERM}) {
    Running sim(project, "sim config/scenarios/squat.json --realtime --watch --no-ctl --no-record");
    REQUIRE_MESSAGE(sim.says("the loop begins"), sim.heard());
    CHECK(sim.end(number) == 130);
    CHECK_MESSAGE(has(sim.heard(), "squat.lua:5: interrupted: the program was told to end"), sim.heard());
  }
}

TEST_CASE("test ends with 130 when a signal comes while the script of a run works, and leaves no run behind") {
  const auto project = project_copy("interrupted_test");
  std::filesystem::remove_all(project / "config/scenarios");
  std::filesystem::create_directories(project / "config/scenarios");
  write(project / "behaviors/tulip/squat.lua", slow);
  const std::string more = R"(", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.5, )"
                           R"("checks": [{"name": "runs", "kind": "at_end", "that": "true"}], "behaviors": [")";
  write(project / "config/scenarios/endless.json", R"({"name": "endless)" + more + R"(squat"]})");
  write(project / "config/scenarios/quick.json", R"({"name": "quick)" + more + R"(stand"]})");
  Running test(project, "test --jobs 2");  // both begin before one is told
  REQUIRE_MESSAGE(test.says("quick (seed 1)"), test.heard());
  CHECK(test.end(SIGTERM) == 130);
  CHECK_FALSE(has(test.heard(), "all passed"));
  CHECK_FALSE(any_process_in(project));
}

TEST_CASE("behavior test ends with 130 when a signal comes while a file works, and the files after it do not run") {
  const auto project = project_copy("interrupted_behavior_test");
  write(project / "behaviors/tulip/a_test.lua", slow_to_load);
  write(project / "behaviors/tulip/b_test.lua", "it('is never run', function() end)\n");
  const Opening opening(project / "behaviors/tulip/a_test.lua");
  Running test(project, "behavior test behaviors/tulip/a_test.lua behaviors/tulip/b_test.lua");
  REQUIRE(opening.seen(test));
  CHECK(test.end(SIGTERM) == 130);
  CHECK_MESSAGE(has(test.heard(), "a_test.lua" + std::string(told_to_end)), test.heard());
  CHECK_FALSE(has(test.heard(), "is never run"));
}

TEST_CASE("repl ends when a signal comes while it loads a behavior, tells the line, and reads no further line") {
  const auto project = project_copy("interrupted_repl");
  write(project / "behaviors/tulip/endless.lua", slow_to_load);
  write(project / "lines.txt", ":play endless\n'a further line'\n");
  const Opening opening(project / "behaviors/tulip/endless.lua");
  Running repl(project, "repl config/scenarios/squat.json <lines.txt");
  REQUIRE(opening.seen(repl));
  CHECK(repl.end(SIGTERM) == 1);  // as after every line that went wrong
  CHECK_MESSAGE(has(repl.heard(), "endless.lua" + std::string(told_to_end)), repl.heard());
  CHECK_FALSE(has(repl.heard(), "a further line"));
}

}  // namespace interruption_test
