#include "kadans/control/control_object_types.h"

#include <stdexcept>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/two_joint_robot.h"

using namespace kadans;

KADANS_REGISTER_CONTROL_OBJECT("registered_pid", make_joint_pid);
KADANS_REGISTER_CONTROL_OBJECT("another_pid", make_joint_pid);

TEST_CASE("Types are found by name and made, a name that is taken is refused with who has it") {
  ControlObjectTypes types;
  types.add("joint_pid", make_joint_pid);
  REQUIRE(types.find("joint_pid") != nullptr);
  const RobotModel model = two_joint_robot();
  CHECK((*types.find("joint_pid"))({model, {0}}) != nullptr);
  CHECK(types.find("joint_pd") == nullptr);
  CHECK_THROWS_WITH_AS(types.add("joint_pid", make_joint_pid, "the plug-in"),
                       "the type of control object 'joint_pid' of the plug-in is taken by kadans",
                       std::invalid_argument);
  CHECK_THROWS_AS(types.add("", make_joint_pid), std::invalid_argument);
  CHECK_THROWS_AS(types.add("nobody", nullptr), std::invalid_argument);
}

TEST_CASE("What a program registers is there, in the order of the names") {
  ControlObjectTypes types;
  types.add("joint_pid", make_joint_pid);
  types.add_registered();
  CHECK(types.names() == std::vector<std::string>{"joint_pid", "another_pid", "registered_pid"});
  CHECK_THROWS_AS(types.add_registered(), std::invalid_argument);
}
