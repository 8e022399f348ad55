// `kadans new behavior`, `scenario` and `sweep`: what they write runs and passes as it is, for robots of all kinds, and
// fails when its point is broken.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"
#include "app/robots_of_tests.h"

namespace kadans::program::new_parts_test {

using namespace robots_of_tests;

namespace {

const char* const limp = " --no-record --set 'joint.*.torque_scale=0'";

void write_all_for(const std::filesystem::path& project, const std::string& robot, const std::string& name) {
  CAPTURE(name);
  const std::string of = " --robot " + robot;
  const Outcome behavior = run("new behavior " + name + "_nod" + of, project);
  CHECK_MESSAGE(behavior.exit_code == 0, (behavior.out + behavior.err));
  CHECK(has(behavior.out, "3 passed, 0 failed"));

  const Outcome played = run("new scenario " + name + "_nods --play " + name + "_nod" + of, project);
  CHECK_MESSAGE(played.exit_code == 0, (played.out + played.err));
  CHECK(has(played.out, "PASSED"));
  CHECK(has(played.err, "With motors that give no torque it fails, as it must: "));
  CHECK(run("sim config/scenarios/" + name + "_nods.json" + limp, project).exit_code == 1);

  const Outcome pushed = run("new scenario " + name + "_pushed --no-run" + of, project);
  CHECK_MESSAGE(pushed.exit_code == 0, (pushed.out + pushed.err));
  CHECK(has(pushed.err, "With motors that give no torque it fails, as it must: "));
  const std::string scenario = "config/scenarios/" + name + "_pushed.json";
  CHECK(run("sim " + scenario + " --no-record", project).exit_code == 0);
  CHECK(run("sim " + scenario + limp, project).exit_code == 1);

  const Outcome sweep = run("new sweep " + name + "_nods" + of, project);
  CHECK_MESSAGE(sweep.exit_code == 0, (sweep.out + sweep.err));
  CHECK(has(sweep.out, "passed: 4 of 4"));
  CHECK(run("check config behaviors", project).exit_code == 0);
}

}  // namespace

TEST_CASE("new behavior, scenario and sweep write what passes for an arm of one joint and for four legs") {
  const auto folder = fresh_folder("new_parts");
  for (const auto& [name, text] : {std::pair{"lever", one_joint()}, std::pair{"four", quadruped()}}) {
    const std::string robot = name;
    write(folder / "from.urdf", text);
    REQUIRE(run("new robot from.urdf --no-run --in own_" + robot + " --name " + robot, folder).exit_code == 0);
    write_all_for(folder / ("own_" + robot), "config/" + robot + "/robot.json", robot);
  }
}

TEST_CASE("new behavior, scenario and sweep write what passes for TULip and for JIWIY's drives") {
  const auto project = project_copy("new_parts_shipped");
  write_all_for(project, "config/tulip/robot.json", "tulip");
  write_all_for(project, "config/jiwiy/servos.json", "jiwiy");
}

TEST_CASE("The test that new behavior writes fails when the behavior no longer looks where its joint is") {
  const auto project = project_copy("new_parts_broken");
  REQUIRE(run("new behavior nod --robot config/jiwiy/robot.json --no-run", project).exit_code == 0);
  REQUIRE(edit(project / "behaviors/jiwiy/nod.lua", "when = missed, to = \"failed\"", "when = missed, to = \"back\""));
  const Outcome tested = run("behavior test behaviors/jiwiy/nod_test.lua", project);
  CHECK(tested.exit_code == 1);
  CHECK(has(tested.out, "FAILED  nod fails when the joint stays where it is"));
}

TEST_CASE("new behavior, scenario and sweep overwrite nothing, and say what they need") {
  const auto project = project_copy("new_parts_refused");
  const std::string of = " --robot config/jiwiy/robot.json";
  const auto refused = [&](const std::string& arguments) {
    const Outcome outcome = run("new " + arguments, project);
    CHECK_MESSAGE(outcome.exit_code == 2, arguments);
    return outcome.err;
  };
  CHECK(has(refused("behavior sine" + of), "sine.lua: is there already; nothing is overwritten"));
  CHECK(has(refused("scenario squat" + of), "squat.json: is there already; nothing is overwritten"));
  CHECK(has(refused("sweep gaze --scenario config/scenarios/squat.json"), "gaze.json: is there already"));
  CHECK(has(refused("behavior nod"), "there are several robots, name one: --robot FILE"));
  CHECK(has(refused("behavior Nod" + of), "the name of a behavior is words of a-z and 0-9 joined by _"));
  CHECK(has(refused("scenario sticks --play stick" + of), "'stick' does not end within 60 s"));
  CHECK(has(refused("scenario other --play none" + of), "unknown behavior 'none'"));
  CHECK(has(refused("sweep several" + of), "has several scenarios, name one: --scenario FILE"));
  CHECK(has(refused("sweep other --scenario config/scenarios/squat.json" + of), "is a scenario of another robot"));
  const auto elsewhere = fresh_folder("new_parts_elsewhere");
  CHECK(has(refused("behavior nod" + of + " --in " + elsewhere.string()), "lies in another project"));
  CHECK(!std::filesystem::exists(project / "config/scenarios/other.json"));
}

}  // namespace kadans::program::new_parts_test
