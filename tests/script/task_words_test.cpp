// The words of whole-body tasks: what they send, what each mistake in them is told, and what is out of reach.
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/control/control_object.h"
#include "script/fixture.h"

namespace task_words_test {

using namespace kadans;
using namespace kadans::script_test;

namespace {

// Reaches up to a centre of mass of 0.6 m, needs 1.2 s for any way, and stands on no foot alone.
class Reach final : public Foresight {
 public:
  Miss miss(const Asked& motion, const Snapshot&) noexcept override {
    asked.assign(motion.goals.begin(), motion.goals.end());
    bool alone = false;
    for (const Goal& goal : asked) {
      if (goal.channel == com_z && goal.value > 0.6)
        return {.why = Why::reach, .by = goal.value - 0.6, .channel = com_z};
      alone = alone || (goal.channel == contact_left && goal.value == 0);
    }
    if (alone) return {.why = Why::bear, .by = 44.4, .joint = 0};
    if (motion.time_s < 0.5) return {.why = Why::topple, .by = 1.2, .after_s = 0.3};
    if (motion.time_s < 1) return {.why = Why::speed, .by = 1, .joint = 0};
    return {};
  }
  static constexpr std::uint32_t contact_left = 107;
  static constexpr std::uint32_t com_z = 102;
  std::vector<Goal> asked;
};

// "posture" gets tasks beside its joints.
struct Body {
  explicit Body(Robot& robot) {
    ObjectInfo& object = robot.catalog.objects[0];
    std::uint32_t channel = 100;
    for (const char* name : {"com_x_m", "com_y_m", "com_z_m", "foot_left.position_x_m", "foot_left.position_y_m",
                             "foot_left.position_z_m", "foot_left.roll_rad", "contact.left", "contact.right"}) {
      object.setpoints.push_back(robot.catalog.setpoints.add({.name = std::string("posture.") + name,
                                                              .unit = "m",
                                                              .min = -2,
                                                              .max = 2,
                                                              .channel = channel++,
                                                              .joint = no_joint}));
    }
    for (const char* name : {"com.weight", "com.priority", "foot_left.weight"}) {
      object.parameters.push_back(
          robot.catalog.parameters.add({std::string("posture.") + name, "", 0, 10, 1, ""}, &values[used++]));
    }
    object.foresight = &reach;
  }
  Reach reach;
  std::array<double, 3> values{};
  std::size_t used = 0;
};

std::string in_enter(const std::string& code) {
  return "local k = require 'kadans'\nreturn k.behavior 'test' { controls = 'posture', k.state 'a' { endless = true, "
         "enter = function(m, s)\n" +
         code + "\nend } }\n";
}

// What was sent to this set-point; NaN: nothing.
double value_of(const Stage& stage, const std::string& setpoint) {
  const SetpointId id = stage.robot.catalog.setpoints.find("posture." + setpoint).value();
  for (const Command& command : stage.applied) {
    if (command.kind == CommandKind::set_point && command.index == id) return command.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double parameter_of(const Stage& stage, const std::string& parameter) {
  const ParameterId id = stage.robot.catalog.parameters.find("posture." + parameter).value();
  for (const Command& command : stage.applied) {
    if (command.kind == CommandKind::set_parameter && command.index == id) return command.value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

struct Mistake {
  const char* code;
  const char* message;
};
const Mistake mistakes[] = {
    {"m.posture:move({}, { time_s = 1 })", "move: there is no target in this table of tasks"},
    {"m.posture:move({ com = { 1 } }, { time_s = 1 })", "has no key 'com', did you mean 'com_m'?"},
    {"m.posture:move({ com_m = 1 }, { time_s = 1 })", "com_m must be a list { x, y, z }, not a number"},
    {"m.posture:move({ com_m = { 'a' } }, { time_s = 1 })", "com_m must be a number, not a string"},
    {"m.posture:move({ com_m = { 1, 1, 1, 1 } }, { time_s = 1 })",
     "com_m must be a list { x, y, z } with nothing else"},
    {"m.posture:move({ com_m = { x = 1 } }, { time_s = 1 })", "com_m must be a list { x, y, z } with nothing else"},
    {"m.posture:move({ com_m = { 3 } }, { time_s = 1 })", "posture.com_x_m = 3 is outside its range -2..2 m"},
    {"m.posture:move({ foot_left = 1 }, { time_s = 1 })", "foot_left must be a table { ... }, not a number"},
    {"m.posture:move({ foot_left = { rol_rad = 1 } }, { time_s = 1 })",
     "foot_left has no key 'rol_rad', did you mean 'roll_rad'?"},
    {"m.posture:move({ foot_left = { roll_rad = true } }, { time_s = 1 })",
     "foot_left.roll_rad must be a number, not a boolean"},
    {"m.posture:move({ l_kne = 1 }, { time_s = 1 })", "has no key 'l_kne', did you mean 'l_knee'?"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, weight = -1 })", "move: weight"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, weight = 11 })",
     "posture.com.weight = 11 is outside its range 0..10"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, priority = 3 })", "move: priority"},
    {"m.posture:move({ l_knee = 1 }, { time_s = 1, weight = 1 })",
     "posture.l_knee.position_rad belongs to no task with a weight"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, contacts = 'left' })",
     "contacts must be a list { ... }, not a string"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, contacts = { 'lefd' } })",
     "contacts must be a list of at least one of its contacts, each once; there is: left, right"},
    {"m.posture:move({ com_m = { 0 } }, { time_s = 1, contacts = { 'left', 'left' } })",
     "contacts must be a list of at least one of its contacts, each once"},
};

}  // namespace

TEST_CASE("words of tasks become set-points, parameters and contacts, and what is left out stays") {
  Stage stage(in_enter(
      "m.posture:move({ com_m = { 0.1, nil, 0.5 }, foot_left = { position_m = { nil, 0.2 }, roll_rad = 0.3 }, "
      "l_knee = 0.4 }, { time_s = 1.5 })\n"
      "m.posture:move({ com_m = { 0.1 } }, { time_s = 1, weight = 3, priority = 2, contacts = { 'left', 'right' } })"));
  const Body body(stage.robot);
  stage.tick();
  CHECK(stage.behavior->error().text() == "");
  CHECK(value_of(stage, "com_x_m") == 0.1);
  CHECK(std::isnan(value_of(stage, "com_y_m")));
  CHECK(value_of(stage, "com_z_m") == 0.5);
  CHECK(std::isnan(value_of(stage, "foot_left.position_x_m")));
  CHECK(value_of(stage, "foot_left.position_y_m") == 0.2);
  CHECK(value_of(stage, "foot_left.roll_rad") == 0.3);
  CHECK(value_of(stage, "l_knee.position_rad") == 0.4);
  CHECK(std::isnan(value_of(stage, "r_knee.position_rad")));
  CHECK(parameter_of(stage, "com.weight") == 3);
  CHECK(parameter_of(stage, "com.priority") == 2);
  CHECK(std::isnan(parameter_of(stage, "foot_left.weight")));
  CHECK(value_of(stage, "contact.left") == 1);
  CHECK(value_of(stage, "contact.right") == 1);
}

TEST_CASE("what is out of reach is told with how far it is, and nothing is sent") {
  Stage stage(
      in_enter("local moving, why, distance_m, setpoint = m.posture:move({ com_m = { nil, nil, 0.85 } }, "
               "{ time_s = 1, weight = 3, contacts = { 'left' } })\n"
               "print(moving, why, distance_m, setpoint)"));
  Body body(stage.robot);
  stage.tick();
  CHECK(stage.said() == "nil out_of_reach 0.25 com_z_m\n");
  CHECK(std::isnan(value_of(stage, "com_z_m")));
  CHECK(std::isnan(parameter_of(stage, "com.weight")));
  CHECK(std::isnan(value_of(stage, "contact.right")));
  REQUIRE(body.reach.asked.size() == 3);  // the target, and both contacts
  CHECK(body.reach.asked[1].value == 1);
  CHECK(body.reach.asked[2].value == 0);
}

TEST_CASE("a motion in too short a time is refused with the least time and a sentence, by move and by set") {
  for (const std::string motion :
       {"m.posture:move({ com_m = { 0.1 } }, { time_s = %t })", "m.posture:set('com_x_m', 0.1, { time_s = %t })"}) {
    const auto said = [&](const std::string& time_s) {
      std::string code = motion;
      code.replace(code.find("%t"), 2, time_s);
      Stage stage(in_enter("print(select(2, " + code + "))"));
      const Body body(stage.robot);
      stage.tick();
      CHECK(std::isnan(value_of(stage, "com_x_m")) == (time_s != "1.5"));
      return stage.said();
    };
    CHECK(said("0.4") == "too_quick 1.2 it topples after 0.3 s: give it at least 1.2 s\n");
    CHECK(said("0.8") == "too_quick 1 l_hip_yaw would be too fast: give it at least 1 s\n");
    CHECK(said("1.5") == "\n");
  }
}

TEST_CASE("to stand on a foot that cannot bear the body is refused with the joint that lacks stiffness, also by set") {
  for (const char* motion : {"m.posture:move({ com_m = { 0.1 } }, { time_s = 2, contacts = { 'right' } })",
                             "m.posture:set('contact.left', 0)"}) {
    Stage stage(in_enter("print(" + std::string(motion) + ")"));
    const Body body(stage.robot);
    stage.tick();
    CHECK(
        stage.said() ==
        "nil cannot_stand 44.4 it cannot stand on one foot: l_hip_yaw has no motor, and its spring lacks 44 Nm/rad\n");
    CHECK(std::isnan(value_of(stage, "contact.left")));
  }
}

TEST_CASE("every mistake in the words of tasks is told at its line, and nothing is sent") {
  for (const Mistake& mistake : mistakes) {
    CAPTURE(mistake.code);
    Stage stage(in_enter(mistake.code));
    const Body body(stage.robot);
    stage.tick();
    const std::string error = stage.behavior->error().text();
    CHECK_MESSAGE(error.starts_with("behaviors/test.lua:3: "), error);
    CHECK_MESSAGE(error.find(mistake.message) != std::string::npos, error);
    CHECK(stage.applied.empty());
  }
}

}  // namespace task_words_test
