#include <cmath>

#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

TEST_CASE("the squat goes down 0.10 m three times and ends standing within 20 s") {
  Stage stage(KADANS_SOURCE_DIR, "behaviors/tulip/squat.lua");
  stage.play(2000);
  INFO(stage.said());
  INFO(stage.behavior->error().text());
  CHECK(stage.behavior->outcome() == "done");
  CHECK(stage.snapshot.time_ns < 20'000'000'000);
  CHECK(stage.snapshot.control_sets == 0b1);
  int crouches = 0;
  double hip_rad = 0, ankle_rad = 0;
  for (const Command& command : stage.applied) {
    if (command.kind != CommandKind::set_point) continue;
    const std::string& name = stage.robot.catalog.setpoints[command.index].name;
    if (name == "posture.l_hip_pitch.position_rad") hip_rad = command.value;
    if (name == "posture.l_ankle_pitch.position_rad") ankle_rad = command.value;
    if (name == "posture.r_knee.position_rad" && command.value > 0.1) {
      ++crouches;
      CHECK(0.275 * 2 * std::cos(command.value / 2) == doctest::Approx(0.45));
    }
    if (name == "posture.l_ankle_pitch.position_rad" && hip_rad != 0) CHECK(ankle_rad == doctest::Approx(hip_rad));
  }
  CHECK(crouches == 3);
  CHECK(hip_rad == 0.0);
}
