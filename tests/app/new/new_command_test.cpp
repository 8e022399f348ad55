#include <doctest/doctest.h>

#include "app/program.h"

using namespace kadans::program;

TEST_CASE("new control-object writes a project under the name given, and says what it wrote") {
  const auto folder = fresh_folder("new_object");
  const Outcome outcome = run("new control-object knee_damper2", folder);
  CHECK(outcome.exit_code == 0);
  for (const char* file :
       {"knee_damper2.h", "knee_damper2.cpp", "knee_damper2_test.cpp", "main.cpp", "CMakeLists.txt"}) {
    CHECK_MESSAGE(std::filesystem::exists(folder / "knee_damper2" / file), file);
    CHECK_MESSAGE(has(outcome.out, file), file);
    CHECK_MESSAGE(!has(read(folder / "knee_damper2" / file), "@"), file);
  }
  CHECK(has(read(folder / "knee_damper2/knee_damper2.h"), "class KneeDamper2 final : public kadans::ControlObject"));
  CHECK(run("new control-object other --plugin --in sub", folder).exit_code == 0);
  CHECK(has(read(folder / "sub/other/plugin.cpp"), "KADANS_PLUGIN(kadans::plugin_type<make_other>(\"other\"))"));
}

TEST_CASE("new control-object overwrites nothing and refuses names that are none") {
  const auto folder = fresh_folder("new_object_refused");
  write(folder / "taken", "mine");
  const Outcome taken = run("new control-object taken", folder);
  CHECK(taken.exit_code == 2);
  CHECK(has(taken.err, "is there already; nothing is overwritten"));
  CHECK(read(folder / "taken") == "mine");
  for (const char* name : {"Knee", "knee-pd", "../knee", "2knee", "knee__pd", "knee_", "''"}) {
    CHECK_MESSAGE(run(std::string("new control-object ") + name, folder).exit_code == 2, name);
  }
}

TEST_CASE("new plant writes a plug-in with both sides of its wire, and a robot that it drives") {
  const auto project = project_copy("new_plant");
  const Outcome made = run("new plant can_drives --robot config/jiwiy/robot.json --in drives", project);
  CHECK_MESSAGE(made.exit_code == 0, made.err);
  for (const char* file : {"can_drives.h", "can_drives.cpp", "can_drives_wire.h", "can_drives_wire.cpp",
                           "can_drives_test.cpp", "plugin.cpp", "CMakeLists.txt"}) {
    CHECK_MESSAGE(has(made.out, file), file);
    CHECK_MESSAGE(!has(read(project / "drives/can_drives" / file), "@"), file);
  }
  const std::string robot = read(project / "config/jiwiy/can_drives.json");
  CHECK(has(robot, "\"based_on\": \"config/jiwiy/robot.json\""));
  CHECK(has(robot, "\"../../drives/can_drives/build/can_drives.so\""));
  CHECK(has(run("new plant can_drives --robot config/jiwiy/robot.json", project).err, "nothing is overwritten"));
  CHECK(
      has(run("new plant udp --robot config/jiwiy/robot.json", project).err, "there is such a type of plant already"));
  CHECK(has(run("new plant other", project).err, "there are several robots, name one: --robot FILE"));
}
