// TULip's kick as a whole: the ball goes where it is told, by either foot, and the robot stands.
#include <cmath>
#include <string>

#include <doctest/doctest.h>

#include "app/assembly/assembly.h"
#include "signal/input_file.h"

namespace kick_test {

using namespace kadans;

namespace {

void replace(std::string& text, const std::string& part, const std::string& by) {
  const std::size_t at = text.find(part);
  REQUIRE(at != std::string::npos);
  text.replace(at, part.size(), by);
}

}  // namespace

TEST_CASE("TULip kicks a ball 2 m far with either foot, straight ahead and to both sides, and stands") {
  struct Asked {
    bool left;
    double rad;
  };
  for (const Asked& asked : {Asked{true, 0.0}, Asked{false, 0.35}, Asked{true, -0.35}}) {
    const bool left = asked.left;
    const double rad = asked.rad;
    // The tip of the foot is 0.235 m behind the middle of the ball.
    const double x_m = 0.07 + 0.235 * std::cos(rad), y_m = (left ? 0.09 : -0.09) + 0.235 * std::sin(rad);
    const std::string file = KADANS_SOURCE_DIR "/config/scenarios/kick.json";
    std::string text = read_input_file(file);
    replace(text, "kick{far_m=3}",
            "kick{far_m=2, left=" + std::to_string(left ? 1 : 0) + ", rad=" + std::to_string(rad) +
                ", ball_x_m=" + std::to_string(x_m) + ", ball_y_m=" + std::to_string(y_m) + "}");
    replace(text, "[0.3, 0.09, 0.095]", "[" + std::to_string(x_m) + ", " + std::to_string(y_m) + ", 0.095]");
    const ScenarioConfig scenario = read_scenario_config_text(text, file);
    RunLog log;
    Assembly robot(scenario, 1, log);
    Checks checks(robot.catalog().signals, scenario.checks);
    const RunResult result = run_scenario(robot.parts(), scenario.duration_s, checks, {});
    const auto value = [&](const char* name) {
      for (const CheckResult& check : result.checks) {
        if (check.name == name) return check.value;
      }
      return std::nan("");
    };
    const auto passed = [&](const char* name) {
      for (const CheckResult& check : result.checks) {
        if (check.name == name) return check.passed;
      }
      return false;
    };
    CAPTURE(rad);
    const double way_x_m = value("the ball goes, m") - x_m, way_y_m = value("the ball goes straight, m") - y_m;
    CHECK(std::hypot(way_x_m, way_y_m) == doctest::Approx(2).epsilon(0.25));
    CHECK(std::abs(std::atan2(way_y_m, way_x_m) - rad) < 0.06);
    CHECK(passed("stays up"));
    CHECK(passed("stands still at the end"));
    CHECK(passed("motors within torque and speed"));
    CHECK(robot.host().finished());
  }
}

}  // namespace kick_test
