#include <doctest/doctest.h>

#include "program.h"

using namespace kadans::program;

TEST_CASE("check passes all shipped files and says what they are") {
  const auto project = project_copy("check_all");
  const Outcome outcome =
      run("check models/tulip/tulip.urdf config/tulip/robot.json config/scenarios/squat.json behaviors/tulip/squat.lua",
          project);
  CHECK(outcome.exit_code == 0);
  CHECK_MESSAGE(outcome.err.empty(), outcome.err);
  CHECK(has(outcome.out, "15 links, 14 joints, 12 motors, 14.000 kg"));
  CHECK(has(outcome.out, "behavior: fits tulip"));
}

TEST_CASE("check reports each broken file with its place, goes on with the others, and exits 2") {
  const auto project = project_copy("check_broken");
  REQUIRE(edit(project / "models/tulip/tulip.urdf", "mass value=\"6.0\"", "mass value=\"-6.0\""));
  REQUIRE(edit(project / "config/scenarios/squat.json", "plant.base.tilt_rad", "plant.base.titl_rad"));
  REQUIRE(edit(project / "behaviors/tulip/squat.lua", "controls", "contrlos"));
  const Outcome outcome =
      run("check models/tulip/tulip.urdf config/scenarios/squat.json behaviors/tulip/squat.lua", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "models/tulip/tulip.urdf:"));
  CHECK(has(outcome.err, "mass"));
  CHECK(outcome.out.empty());
}

TEST_CASE("check names the parameter of a behavior that a robot's file has wrong") {
  const auto project = project_copy("check_behavior_value");
  REQUIRE(edit(project / "config/tulip/soft.json", "\"roll_way\":", "\"roll_wya\":"));
  const Outcome outcome = run("check config/tulip/soft.json", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "config/tulip/soft.json:"));
  const std::string problem = "behavior 'get_up' has no parameter 'roll_wya', did you mean 'roll_way'?";
  CHECK(has(outcome.err, problem));
  CHECK(outcome.err.find(problem) == outcome.err.rfind(problem));  // though step_out calls get_up, too
}

TEST_CASE("check names a signal that nobody declares, with the nearest that somebody does") {
  const auto project = project_copy("check_signal");
  REQUIRE(edit(project / "config/scenarios/squat.json", "plant.base.tilt_rad", "plant.base.titl_rad"));
  const Outcome outcome = run("check config/scenarios/squat.json", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "config/scenarios/squat.json:"));
  CHECK(has(outcome.err, "unknown signal 'plant.base.titl_rad', did you mean 'plant.base.tilt_rad'?"));
}

TEST_CASE("check refuses what it does not know, and a behavior without a robot") {
  const auto project = project_copy("check_unknown");
  write(project / "notes.txt", "hello");
  CHECK(has(run("check notes.txt", project).err, "notes.txt: not a file that can be checked"));
  std::filesystem::create_directories(project / "behaviors/nobody");
  std::filesystem::copy(project / "behaviors/tulip/squat.lua", project / "behaviors/nobody/squat.lua");
  CHECK(has(run("check behaviors/nobody/squat.lua", project).err, "--robot FILE"));
  CHECK(run("check behaviors/nobody/squat.lua --robot config/tulip/robot.json", project).exit_code == 0);
}
