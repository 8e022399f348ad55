// SIGINT and SIGTERM reach a script that would go on: sim, test and repl end, whatever it does.
#include <csignal>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/assembly.h"
#include "app/terminal.h"
#include "program.h"

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
