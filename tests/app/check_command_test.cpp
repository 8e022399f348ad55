#include <cstdlib>

#include <doctest/doctest.h>
#include <stdlib.h>

#include "app/program.h"

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

TEST_CASE("check tells what is odd in a URDF and passes it") {
  const auto project = project_copy("check_odd");
  REQUIRE(edit(project / "models/jiwiy/jiwiy.urdf", "<material name=\"glass\"/>",
               "<material name=\"glass\"><color rgba=\"1 0 0 1\"/></material>"));
  const Outcome outcome = run("check models/jiwiy/jiwiy.urdf", project);
  CHECK(outcome.exit_code == 0);
  CHECK(has(outcome.out, "\nwarning: models/jiwiy/jiwiy.urdf:63:7: material 'glass' had another color before"));
}

TEST_CASE("check names the parameter of a behavior that a robot's file has wrong") {
  const auto project = project_copy("check_behavior_value");
  REQUIRE(edit(project / "config/tulip/soft.json", "\"roll_way\":", "\"roll_wya\":"));
  const Outcome outcome = run("check config/tulip/soft.json", project);
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "config/tulip/soft.json:"));
  const std::string problem = "behavior 'get_up' has no parameter 'roll_wya', did you mean 'roll_way'?";
  CHECK(has(outcome.err, problem));
  CHECK(outcome.err.find(problem) == outcome.err.rfind(problem));  // though keep_up and stay_up call get_up, too
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

TEST_CASE("check takes folders and patterns, knows modules and tests, and passes over what is none of ours") {
  const auto project = project_copy("check_folders");
  write(project / "config/notes.json", "{\"hello\": 1}");
  write(project / "behaviors/.hidden.lua", "not Lua");
  const Outcome all = run("check .", project);
  CHECK_MESSAGE(all.exit_code == 0, all.err);
  CHECK(has(all.out, "behaviors/lib/legs.lua  a module"));
  CHECK(has(all.out, "behaviors/tulip/squat_test.lua  tests"));
  CHECK(has(all.out, "behaviors/tulip/squat.lua  behavior: fits tulip"));
  CHECK(has(all.out, "behaviors/jiwiy/sine.lua  behavior: fits jiwiy"));
  CHECK(has(all.out, "config/scenarios/squat.json  scenario:"));
  CHECK(has(all.out, "config/sweeps/push_varied.json  sweep:"));
  CHECK(has(all.out, "models/tulip/tulip.urdf  robot description:"));
  CHECK_FALSE(has(all.out, "notes.json"));
  CHECK_FALSE(has(all.out, "schema.json"));
  CHECK(run("check config/notes.json", project).exit_code == 2);

  const Outcome some = run("check 'behaviors/*/s*_test.lua' config/tulip behaviors/tulip/squat_test.lua", project);
  CHECK(some.exit_code == 0);
  CHECK(has(some.out, "behaviors/tulip/squat_test.lua  tests"));
  CHECK(some.out.find("squat_test.lua") == some.out.rfind("squat_test.lua"));  // each once
  CHECK(has(some.out, "config/tulip/soft.json"));
  CHECK_FALSE(has(some.out, "behaviors/tulip/squat.lua"));
  const Outcome none = run("check 'behaviors/*/nothing*'", project);
  CHECK(none.exit_code == 2);
  CHECK(has(none.err, "nothing has a name like that"));
  CHECK(has(run("check nowhere", project).err, "nowhere"));

  write(project / "behaviors/lib/broken.lua", "return {\n");
  const Outcome broken = run("check behaviors", project);
  CHECK(broken.exit_code == 2);
  CHECK(has(broken.err, "behaviors/lib/broken.lua:2:"));
  CHECK(has(broken.out, "behaviors/tulip/squat.lua"));  // the others are told
  CHECK(run("behavior check behaviors", project).exit_code == 2);
}

TEST_CASE(
    "what behavior check finds is found in a scenario, a sweep and its behaviors, and sim, run and test refuse it") {
  const auto project = project_copy("check_played");
  REQUIRE(
      edit(project / "behaviors/tulip/squat.lua", "m.posture:set_gains(\"stiff\")", "m.posture:set_gains(\"stif\")"));
  const std::string problem = "behaviors/tulip/squat.lua:33: 'posture' has no gains 'stif', did you mean 'stiff'?";
  for (const char* command :
       {"check config/scenarios/squat.json", "check config/scenarios/list_of_behaviors.json",
        "sim config/scenarios/squat.json", "sim config/scenarios/gaze_saccade.json --play behaviors/tulip/squat.lua",
        "run config/tulip/robot.json --play squat --plant ideal --threads-on-virtual-time --no-ctl --duration 1",
        "run config/tulip/robot.json --play squat --plant ideal --threads-on-virtual-time --no-ctl --behaviors process",
        "run config/tulip/robot.json --play show --plant ideal --threads-on-virtual-time --no-ctl", "test squat"}) {
    CAPTURE(command);
    const Outcome outcome = run(command, project);
    CHECK(outcome.exit_code == 2);
    CHECK(outcome.out.empty());
    if (!has(command, "saccade")) CHECK_MESSAGE(has(outcome.err, problem), outcome.err);
  }
  CHECK_FALSE(std::filesystem::exists(project / "squat.mcap"));
  CHECK(run("test stand_nothing_plays slope_up --list", project).exit_code == 2);
  write(
      project / "config/sweeps/plan.json",
      R"({"name": "s", "scenarios": ["config/scenarios/squat.json"], "cases": 2, "vary": {"ground.friction": {"uniform": [0.9, 1]}}})");
  for (const char* command : {"check config/sweeps/plan.json", "sweep config/sweeps/plan.json"}) {
    const Outcome outcome = run(command, project);
    CHECK(outcome.exit_code == 2);
    CHECK_MESSAGE(has(outcome.err, problem), outcome.err);
  }
}

TEST_CASE("the behaviors of a scenario's events are checked, too, and a record runs again whatever check finds today") {
  const auto project = project_copy("check_events");
  write(project / "config/scenarios/later.json",
        R"({"name": "later", "robot": "config/tulip/robot.json", "plant": "ideal", "duration_s": 0.5,
            "behaviors": ["stand"], "events": [{"at_s": 0.2, "do": "replace", "list": "wave"}]})");
  REQUIRE(run("sim config/scenarios/later.json", project).exit_code == 0);
  REQUIRE(edit(project / "behaviors/tulip/wave.lua", "{ after = 20, to = \"failed\", why = \"took too long\" },",
               "{ after = 20, to = \"failed\", why = \"took too long\" }, { on = \"nobody\", to = \"failed\" },"));
  const Outcome refused = run("sim config/scenarios/later.json", project);
  CHECK(refused.exit_code == 2);
  CHECK(has(refused.err, "nobody emits the event 'nobody'"));
  CHECK(run("check config/scenarios/later.json", project).exit_code == 2);
  CHECK(run("replay later.mcap --from-record", project).exit_code == 0);
  CHECK(run("replay later.mcap", project).exit_code == 0);  // it runs, with the file as it is
}

TEST_CASE("check --strict makes warnings of a URDF errors, for the URDF and for a robot that has it") {
  const auto project = project_copy("check_strict");
  REQUIRE(edit(project / "models/jiwiy/jiwiy.urdf", "</robot>", "<gazebo/><gazebo/></robot>"));
  const std::string what = "<gazebo> in <robot> is not known to URDF, and not used (2 such in this line)";
  const Outcome told = run("check config/jiwiy/robot.json", project);
  CHECK(told.exit_code == 0);
  CHECK(has(told.out, "\nwarning: "));
  CHECK(has(told.out, what));
  for (const char* file : {"models/jiwiy/jiwiy.urdf", "config/jiwiy/robot.json"}) {
    const Outcome strict = run(std::string("check --strict ") + file, project);
    CHECK(strict.exit_code == 2);
    CHECK(has(strict.err, what));
  }
}

TEST_CASE("check reads a URDF whose name ends in capitals, and finds meshes of a package that it is told of") {
  const auto project = project_copy("check_package");
  REQUIRE(
      edit(project / "models/jiwiy/jiwiy.urdf", "</robot>",
           "<link name=\"cap\"><visual><geometry><mesh filename=\"package://caps/cap.stl\"/></geometry></visual></link>"
           "<joint name=\"cap\" type=\"fixed\"><parent link=\"base\"/><child link=\"cap\"/></joint></robot>"));
  std::filesystem::rename(project / "models/jiwiy/jiwiy.urdf", project / "JIWIY.URDF");
  std::filesystem::create_directories(project / "there");
  write(project / "there/cap.stl", "solid");
  const Outcome without = run("check JIWIY.URDF", project);
  CHECK(without.exit_code == 0);
  CHECK(has(without.out, "ends in .URDF"));
  CHECK(has(without.out, "--package caps=FOLDER"));
  const Outcome with = run("check --package caps=there JIWIY.URDF", project);
  CHECK(with.exit_code == 0);
  CHECK_FALSE(has(with.out, "caps"));
  CHECK(has(run("check --package caps=nowhere JIWIY.URDF", project).err, "must be NAME=FOLDER"));
}

namespace {

// A program `xacro` that is first in PATH.
class FakeXacro {
 public:
  FakeXacro(const std::filesystem::path& folder, const std::string& script) {
    write(folder / "bin/xacro", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(folder / "bin/xacro", std::filesystem::perms::owner_all);
    setenv("PATH", (folder / "bin").string().append(":").append(path_).c_str(), 1);  // NOLINT: no thread
  }
  ~FakeXacro() { setenv("PATH", path_.c_str(), 1); }  // NOLINT: no thread
  FakeXacro(const FakeXacro&) = delete;
  FakeXacro& operator=(const FakeXacro&) = delete;

 private:
  std::string path_ = std::getenv("PATH");  // NOLINT: no thread
};

}  // namespace

TEST_CASE(
    "check puts in values for what a URDF has left of xacro, says which, and leaves more of it to the program xacro") {
  const auto project = project_copy("check_xacro_values");
  const std::string file = "models/jiwiy/jiwiy.urdf";
  REQUIRE(edit(project / file, "</robot>",
               "<xacro:arg name=\"cap\" default=\"cap\"/><link name=\"$(arg cap)\"/><joint name=\"cap\" "
               "type=\"fixed\"><parent link=\"base\"/><child link=\"cap\"/></joint></robot>"));
  const Outcome told = run("check " + file, project);
  CHECK_MESSAGE(told.exit_code == 0, told.err);
  CHECK(has(told.out, "values are put in for names of xacro: 'cap' is 'cap' (its default)"));
  CHECK(has(run("check --strict " + file, project).err, "values are put in for names of xacro"));
  CHECK(has(run("check config/jiwiy/robot.json", project).err, "this is xacro, expand it first"));
  REQUIRE(edit(project / file, "<xacro:arg ", "<xacro:include filename=\"none\"/><xacro:arg "));
  CHECK(has(run("check " + file, project).err, "<xacro:include>: this is xacro, expand it first"));
  std::filesystem::create_directories(project / "bin");
  const FakeXacro xacro(project, "sed 's/<xacro:[^>]*>//g; s/$(arg cap)/cap/' \"$1\"");
  CHECK(run("check " + file, project).exit_code == 0);
}

TEST_CASE("check expands xacro with the program xacro, shows its errors, and says what to do without it") {
  const auto project = project_copy("check_xacro");
  std::filesystem::create_directories(project / "bin");
  const std::string file = "models/it's $(touch made).urdf.xacro";  // no shell reads it
  std::filesystem::rename(project / "models/jiwiy/jiwiy.urdf", project / file);
  const std::string check = "check \"models/it's \\$(touch made).urdf.xacro\"";
  {
    const FakeXacro xacro(project, "exec cat \"$1\"");
    const Outcome outcome = run(check, project);
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.err);
    CHECK(has(outcome.out, "3 links, 2 joints"));
    CHECK_FALSE(std::filesystem::exists(project / "made"));
  }
  {
    const FakeXacro xacro(project, "echo 'no such macro: leg' >&2; exit 2");
    const Outcome outcome = run(check, project);
    CHECK(outcome.exit_code == 2);
    CHECK(has(outcome.err, "xacro could not expand it, and says:\nno such macro: leg"));
  }
  std::filesystem::remove(project / "bin/xacro");
  setenv("KADANS_TEST_PATH", std::getenv("PATH"), 1);  // NOLINT: no thread
  setenv("PATH", (project / "bin").c_str(), 1);        // NOLINT: no thread
  const Outcome outcome = run(check, project);
  setenv("PATH", std::getenv("KADANS_TEST_PATH"), 1);  // NOLINT: no thread
  CHECK(outcome.exit_code == 2);
  CHECK(has(outcome.err, "that is not installed here"));
  CHECK(has(outcome.err, ".urdf'"));
}
