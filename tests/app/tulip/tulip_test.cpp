#include <sstream>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "app/program.h"

using namespace kadans;

TEST_CASE("TULip squats three times within every bound of its scenario, for several seeds") {
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/squat.json");
  for (const std::uint64_t seed : {1U, 77U}) {
    CAPTURE(seed);
    RunLog log;
    Assembly robot(scenario, seed, log);
    Checks checks(robot.catalog().signals, scenario.checks);
    const RunParts parts = robot.parts();
    const RunResult result = run_scenario(parts, scenario.duration_s, checks, {});
    for (const CheckResult& check : result.checks) {
      CAPTURE(check.name);
      CAPTURE(check.value);
      CAPTURE(check.at_s);
      CHECK(check.passed);
    }
    CHECK(result.passed);
    const auto height_m = [&](std::size_t check) { return result.checks.at(check).value; };
    CHECK(height_m(2) - height_m(1) == doctest::Approx(0.10).epsilon(0.05));  // standing minus crouching
    CHECK(result.faults.empty());
    CHECK(result.commands_refused == 0);
    CHECK(robot.host().finished());
    std::size_t crouches = 0;
    for (const Transition& transition : log.transitions()) crouches += transition.to == "squat" ? 1 : 0;
    CHECK(crouches == 3);
  }
}

TEST_CASE(
    "A run that ends in the middle of a squat leaves TULip standing in its safe posture until the drives let go") {
  using namespace kadans::program;
  const auto folder = fresh_folder("stands_down");
  const std::string robot = KADANS_SOURCE_DIR "/config/tulip/robot.json";
  const Outcome squat =
      run("run " + robot + " --play squat --duration 3 --threads-on-virtual-time --no-ctl --record end.mcap", folder);
  REQUIRE_MESSAGE(squat.exit_code == 0, squat.err);
  std::istringstream table(
      run("log csv end.mcap plant.base.tilt_rad plant.base.height_m safety.level --from 3", folder).out);
  std::string line;
  std::getline(table, line);  // names
  double time_s = 0, tilt_rad = 0, height_m = 0, level = 0, stood_until_s = 0;
  char comma = 0;
  while (std::getline(table, line)) {
    std::istringstream(line) >> time_s >> comma >> tilt_rad >> comma >> height_m >> comma >> level;
    if (level >= 3) break;
    CHECK(tilt_rad < 0.02);
    stood_until_s = time_s;
  }
  CHECK(level == 3);           // from here on it damps, and falls
  CHECK(stood_until_s > 4.6);  // safe.time_s later
  CHECK(height_m > 0.85);
}
