// The options of motions: what each field does, and what each mistake in it is told.
#include <doctest/doctest.h>

#include "script/check/check_behavior.h"
#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string in_enter(const std::string& code) {
  return "local k = require 'kadans'\nreturn k.behavior 'test' { controls = 'posture', k.state 'a' { endless = true, "
         "enter = function(m, s)\n" +
         code + "\nend } }\n";
}

// As the control engine marks them.
void lead(Robot& robot) {
  for (SetpointId id = 0; id < robot.catalog.setpoints.size(); ++id) {
    if (robot.catalog.setpoints[id].name != "posture.r_knee.position_rad") robot.catalog.setpoints.set_follows(id);
  }
}

SetpointId setpoint(const Robot& robot, const std::string& name) { return robot.catalog.setpoints.find(name).value(); }

std::vector<Command> sent(Stage& stage, const std::string& name) {
  std::vector<Command> all;
  for (const Command& command : stage.applied) {
    const bool moves = command.kind == CommandKind::set_point || command.kind == CommandKind::trapezoid ||
                       command.kind == CommandKind::via_point;
    if (moves && command.index == setpoint(stage.robot, name)) all.push_back(command);
  }
  return all;
}

struct Mistake {
  const char* code;
  const char* message;
  bool checked = true;  // `behavior check` finds it as well
};

const Mistake mistakes[] = {
    {"m.posture:move('stand')", "move needs { time_s = seconds } at the end"},
    {"m.posture:move('stand', {})", "move needs { time_s = seconds } at the end"},
    {"m.posture:move('stand', 1)", "move: the last argument must be a table { ... }, not a number"},
    {"m.posture:move('stand', { time = 1 })", "move has no key 'time', did you mean 'time_s'?"},
    {"m.posture:move('stand', { time_s = '1' })", "move: time_s must be a number"},
    {"m.posture:move('stand', { time_s = -1 })", "move: time_s"},
    {"m.posture:move('stand', { time_s = 601 })", "move: time_s"},
    {"m.posture:move('stand', { time_s = 0/0 })", "move: time_s must be a number in 0..600 s", false},
    {"m.posture:move('stand', { time_s = 1, profile = 'trapeze' })",
     "move: unknown profile 'trapeze'; there is: minimum_jerk, trapezoid"},
    {"m.posture:move('stand', { time_s = 1, profile = 'trapezod' })",
     "move: unknown profile 'trapezod', did you mean 'trapezoid'?"},
    {"m.posture:move('stand', { time_s = 1, profile = 3 })", "move: profile must be a text"},
    {"m.posture:move('stand', { profile = 'trapezoid' })",
     "move: a trapezoid needs time_s, or velocity_max and acceleration_max"},
    {"m.posture:move('stand', { profile = 'trapezoid', velocity_max_rad_s = 1 })",
     "move: a trapezoid needs time_s, or velocity_max and acceleration_max"},
    {"m.posture:move('stand', { profile = 'trapezoid', time_s = 0 })", "move: a trapezoid needs time_s > 0", false},
    {"m.posture:move('stand', { profile = 'trapezoid', time_s = 1, velocity_max_rad_s = 1, acceleration_max_rad_s2 = 1 "
     "})",
     "move: a trapezoid takes time_s or limits, not both"},
    {"m.posture:move('stand', { time_s = 1, velocity_max_rad_s = 1 })", "move: "},
    {"m.posture:move('stand', { profile = 'trapezoid', velocity_max_rad_s = 0, acceleration_max_rad_s2 = 1 })",
     "move: velocity_max_rad_s"},
    {"m.posture:move('stand', { profile = 'trapezoid', velocity_max_rad_s = 1, acceleration_max_rad_s2 = 1e9 })",
     "move: acceleration_max_rad_s2"},
    {"m.posture:move('stand', { profile = 'trapezoid', velocity_max_rad_s = 9, acceleration_max_rad_s2 = 1 })",
     "posture.l_hip_yaw.position_rad: velocity_max_rad_s = 9 is more than the joint's 8", false},
    {"m.posture:move('stand', { profile = 'trapezoid', velocity_max_m_s = 1, acceleration_max_rad_s2 = 1 })",
     "move has no key 'velocity_max_m_s', did you mean 'velocity_max_rad_s'?"},
    {"m.posture:set('l_knee.position_rad', 1, { profile = 'trapezoid', velocity_max_m_s = 1 })",
     "set: velocity_max_m_s does not fit a set-point in rad", false},
    {"m.posture:set('l_knee.position_rad', 1, 2)", "set: the last argument must be a table { ... }, not a number"},
    {"m.posture:set('l_knee.position_rad', 3)", "posture.l_knee.position_rad = 3 is outside its range 0..2.35 rad"},
    {"m.posture:set('l_kne.position_rad', 1)",
     "'posture' has no set-point 'l_kne.position_rad', did you mean 'l_knee.position_rad'?"},
    {"m.posture:setpoint('l_kne.position_rad')",
     "'posture' has no set-point 'l_kne.position_rad', did you mean 'l_knee.position_rad'?"},
    {"m.posture:move({ l_kne = 1 }, { time_s = 1 })", "did you mean 'l_knee'?"},
    {"m.posture:move({ l_knee = 3 }, { time_s = 1 })",
     "posture.l_knee.position_rad = 3 is outside its range 0..2.35 rad"},
    {"m.posture:move({ l_knee = 0.1 }, { time_s = 1, relative = 1 })", "move: relative must be true or false"},
    {"m.posture:move('stand', { time_s = 1, relative = true })",
     "move: relative = true needs a table joint = offset, not the pose 'stand'", false},
    {"m.posture:move({ l_knee = -0.1 }, { time_s = 1, relative = true })",
     "posture.l_knee.position_rad = -0.1 is outside its range 0..2.35 rad", false},
    {"m.posture:move({ r_knee = 0.1 }, { time_s = 1, relative = true })",
     "posture.r_knee.position_rad: its control object cannot say where it is; it moves by { time_s = } only", false},
    {"m.posture:follow('stand')", "follow needs { velocity_max_rad_s =, acceleration_max_rad_s2 = } at the end"},
    {"m.posture:follow({ l_knee = 1 }, { velocity_max_rad_s = 1 })",
     "follow needs { velocity_max_rad_s =, acceleration_max_rad_s2 = } at the end", false},
    {"m.posture:follow({ l_knee = 1 }, { time_s = 1 })", "follow has no key 'time_s'"},
    {"m.posture:move_through('stand')", "move_through needs a list", false},
    {"m.posture:move_through({})", "move_through takes 1..16 points, not 0", false},
    {"m.posture:move_through({ 'stand' })", "move_through: point 1 must be { pose, time_s = seconds }, not a string",
     false},
    {"m.posture:move_through({ { { l_knee = 1 } } })", "needs time_s > 0"},
    {"m.posture:move_through({ { { l_knee = 1 }, time = 1 } })",
     "a point of move_through has no key 'time', did you mean 'time_s'?"},
    {"m.posture:move_through({ { { l_kne = 1 }, time_s = 1 } })", "did you mean 'l_knee'?"},
    {"m.posture:move_through({ { 'stnd', time_s = 1 } })", "unknown pose 'stnd', did you mean 'stand'?"},
    {"m.posture:move_through({ { 3, time_s = 1 } })", "a point of move_through needs a pose", false},
    {"m.posture:move_through({ { { l_knee = 1 }, time_s = 1 } }, { relativ = true })",
     "move_through has no key 'relativ', did you mean 'relative'?"},
    {"m.posture:move_through({ { { l_knee = 2.3 }, time_s = 0.5 }, { { l_knee = 2.2 }, time_s = 0.5 } })",
     "move_through: between the points posture.l_knee.position_rad swings to", false},
};

}  // namespace

TEST_CASE("every mistake in a motion is told at its line, when it runs and, where the text shows it, by the check") {
  for (const Mistake& mistake : mistakes) {
    CAPTURE(mistake.code);
    Stage stage(in_enter(mistake.code));
    lead(stage.robot);
    for (Joint& joint : stage.robot.model.joints) joint.velocity_max_rad_s = 8;
    stage.tick();
    const std::string error = stage.behavior->error().text();
    CHECK_MESSAGE(error.starts_with("behaviors/test.lua:3: "), error);
    CHECK_MESSAGE(error.find(mistake.message) != std::string::npos, error);
    CHECK(stage.applied.empty());

    const auto found =
        check_behavior(stage.scripts.root, stage.scripts.root / "behaviors/test.lua", stage.robot.catalog);
    REQUIRE(found.size() == (mistake.checked ? 1 : 0));
    if (!mistake.checked) continue;
    CHECK(found[0].line == 3);
    CHECK_MESSAGE(found[0].message.find(mistake.message) != std::string::npos, found[0].message);
  }
}

TEST_CASE("good motions of every kind pass the check") {
  Stage stage(
      in_enter("local point = { 'stand', time_s = 1 }\n"
               "m.posture:move('stand', { time_s = 1, profile = 'minimum_jerk' })\n"
               "m.posture:move({ l_knee = 5, r_knee = -5 }, { time_s = s.time_s, relative = true })\n"
               "m.posture:move(k.pose 'stand', { profile = 'trapezoid', velocity_max_rad_s = 1, "
               "acceleration_max_rad_s2 = 2 })\n"
               "m.posture:move_through({ point, { { l_knee = 1 }, time_s = 2 }, { 'lean', time_s = 1 } })\n"
               "m.posture:follow({ l_knee = m.time_s }, { velocity_max_rad_s = 1, acceleration_max_rad_s2 = "
               "2 })\n"
               "m.posture:set('l_knee.position_rad', m.posture:setpoint('l_knee.position_rad'))"));
  const auto found = check_behavior(stage.scripts.root, stage.scripts.root / "behaviors/test.lua", stage.robot.catalog);
  for (const InputProblem& problem : found) MESSAGE(problem.message);
  CHECK(found.empty());
}

TEST_CASE("a relative motion adds to where the set-point is, or the joint before its object is active") {
  Stage stage(in_enter("m.posture:move({ l_knee = 0.5, l_hip_yaw = -0.25 }, { time_s = 1, relative = true })"));
  lead(stage.robot);
  stage.snapshot.setpoints[setpoint(stage.robot, "posture.l_knee.position_rad")] = {1.0, 0.0};
  stage.snapshot.joints.joints[0].position_rad = 0.125;
  stage.tick();
  REQUIRE(sent(stage, "posture.l_knee.position_rad").size() == 1);
  CHECK(sent(stage, "posture.l_knee.position_rad")[0].value == 1.5);
  CHECK(sent(stage, "posture.l_hip_yaw.position_rad")[0].value == -0.125);
}

TEST_CASE("a trapezoid within limits takes as long on every joint as on the slowest") {
  Stage stage(
      in_enter("m.posture:move({ l_knee = 1, l_hip_yaw = 0.5 }, { profile = 'trapezoid', velocity_max_rad_s = 2, "
               "acceleration_max_rad_s2 = 10 })"));
  lead(stage.robot);
  stage.tick();
  const auto knee = sent(stage, "posture.l_knee.position_rad"), hip = sent(stage, "posture.l_hip_yaw.position_rad");
  REQUIRE(knee.size() == 1);
  CHECK(knee[0].kind == CommandKind::trapezoid);
  CHECK(knee[0].velocity == 2);
  CHECK(knee[0].acceleration == 10);
  CHECK(knee[0].duration_s == doctest::Approx(0.71));
  CHECK(hip[0].duration_s == knee[0].duration_s);
}

TEST_CASE("a spline goes through the points that name the joint, and follow sends one command a tick") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'test' { controls = 'posture', initial = 'a', k.state 'a' {\n"
      "run = function(m) local moving = m.posture:move_through({ { { l_knee = 0.5, l_hip_yaw = 0.1 }, time_s = 0.2 },\n"
      "{ { l_knee = 1 }, time_s = 0.1 }, { { l_knee = 1.5, l_hip_yaw = 0.2 }, time_s = 0.1 } })\n"
      "print(moving.done) moving:cancel() print(moving.done) end, { on = 'run.done', to = 'b' } },\n"
      "k.state 'b' { during = function(m) m.posture:follow({ l_knee = m.time_s }, { velocity_max_rad_s = 1, "
      "acceleration_max_rad_s2 = 5 }) end } }");
  lead(stage.robot);
  stage.tick();
  const auto knee = sent(stage, "posture.l_knee.position_rad"), hip = sent(stage, "posture.l_hip_yaw.position_rad");
  REQUIRE(knee.size() == 3);
  REQUIRE(hip.size() == 2);
  CHECK(knee[2].count == 2);
  CHECK(knee[2].value == 1.5);
  CHECK(hip[1].count == 1);
  CHECK(hip[1].duration_s == doctest::Approx(0.2));
  stage.tick(10);
  CHECK(stage.said() == "false\ntrue\n");
  CHECK(stage.commands(CommandKind::cancel_motion) == 2);
  const std::size_t before = stage.commands(CommandKind::trapezoid);
  stage.tick(3);
  CHECK(stage.commands(CommandKind::trapezoid) == before + 3);
}
