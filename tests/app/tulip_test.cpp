#include <doctest/doctest.h>

#include "app/assembly.h"

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
