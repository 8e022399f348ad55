// Motions, and the transactions that carry them.
#include <doctest/doctest.h>

#include "script/fixture.h"

using namespace kadans;
using namespace kadans::script_test;

namespace {

std::string in_run(const std::string& code) {
  return "local k = require 'kadans'\nreturn k.behavior 'test' { controls = 'posture', k.state 'a' { run = function(m, "
         "s)\n" +
         code + "\nend } }\n";
}

}  // namespace

TEST_CASE("what a tick asks for is one transaction, with the switch to the behavior's control set first") {
  Stage stage(in_run(
      "m.posture:set_gains('stiff') m.posture:move('stand', { time_s = 2 }) m.posture:set('l_knee.position_rad', 1)"));
  stage.snapshot.control_sets = 0b10;
  stage.tick();
  REQUIRE(stage.applied.size() == 1 + 1 + 12 + 12 + 1);
  CHECK(stage.applied[0].kind == CommandKind::transaction);
  CHECK(stage.applied[0].count == 26);
  CHECK(stage.applied[1].kind == CommandKind::switch_set);
  CHECK(stage.applied[1].index == 0);
  CHECK(stage.applied[2].kind == CommandKind::set_parameter);
  CHECK(stage.applied[2].value == 200.0);
  CHECK(stage.applied[14].duration_s == 2.0);
  CHECK(stage.applied[26].value == 1.0);
  CHECK(stage.applied[26].duration_s == 0.0);
}

TEST_CASE("a behavior whose control set is active already does not switch") {
  Stage stage(in_run("m.posture:set_gains('stiff')"));
  stage.tick();
  CHECK(stage.commands(CommandKind::switch_set) == 0);
  CHECK(stage.commands(CommandKind::set_parameter) == 12);
}

TEST_CASE("a behavior sees the objects of its control set only") {
  Stage stage(in_run("local x = m.arms"));
  stage.tick();
  CHECK(stage.behavior->error().text() ==
        "behaviors/test.lua:3: control object 'arms' is not in this behavior's control set, 'posture'");
}

TEST_CASE("wait goes on when the motion has arrived") {
  Stage stage(in_run("print(m.posture:move('lean', { time_s = 0.5 }):wait()) print(s.time_s)"));
  stage.play(100);
  CHECK(stage.said() == "true\n0.5\n");
}

TEST_CASE("done is false while the motion is under way, and a shorter one is done before a longer one") {
  Stage stage(in_run(
      "local slow = m.posture:move({ l_knee = 1 }, { time_s = 0.5 })\n"
      "local fast = m.posture:move({ r_knee = 1 }, { time_s = 0.1 })\n"
      "print(slow.done, fast.done) fast:wait() print(slow.done, fast.done, s.time_s) slow:wait() print(slow.done)"));
  stage.play(100);
  CHECK(stage.said() == "false false\nfalse true 0.11\ntrue\n");
}

TEST_CASE("cancel sends a cancellation for every joint of the motion, once") {
  Stage stage(
      in_run("local motion = m.posture:move({ l_knee = 1, r_knee = 1 }, { time_s = 0.5 }) m:wait(0.1)\n"
             "print(motion:cancel(), motion.done) print(motion:wait()) motion:cancel()"));
  stage.play(30);
  CHECK(stage.said() == "true true\nnil cancelled\n");
  CHECK(stage.commands(CommandKind::cancel_motion) == 2);
}

TEST_CASE("a full queue refuses the whole transaction: the behavior gets nil, \"queue_full\" and the log a warning") {
  Stage stage(
      in_run("for i = 1, 30 do local ok, why = m.posture:set_gains('stiff') if not ok then print(i, why) end end"));
  stage.tick();
  CHECK(stage.applied.empty());
  CHECK(stage.behavior->transactions_refused() == 1);
  CHECK(stage.sender.refused() > 0);
  CHECK(stage.said().find("22 queue_full") == 0);
  CHECK(stage.said().find("were refused, all of them") != std::string::npos);
}

TEST_CASE("a motion of a refused transaction is over, and its wait says why") {
  Stage stage(
      in_run("local motion = m.posture:move('lean', { time_s = 1 })\n"
             "for i = 1, 30 do m.posture:set_gains('stiff') end print(motion:wait())"));
  stage.play(5);
  CHECK(stage.said().find("nil queue_full") != std::string::npos);
}

TEST_CASE("a control engine that takes nothing: the queue fills up, refuses, and the behavior goes on") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'test' { k.state 'a' { during = function(m)\n"
      "local ok, why = m.posture:set_gains('stiff') m.vars.refused = (m.vars.refused or 0) + (ok and 0 or 1) end } }");
  stage.applying = false;
  stage.tick(200);
  CHECK_FALSE(stage.behavior->failed());
  CHECK(stage.queue.size() == 78 * 13);
  CHECK(stage.behavior->transactions_refused() == 200 - 78);
}

TEST_CASE("a motion that the control engine refuses is over at once: its outcome, its reason and the log say why") {
  Stage stage(
      in_run("local motion = m.posture:move('lean', { time_s = 0.5 }) print(motion.outcome, motion.reason)\n"
             "print(motion:wait()) print(s.time_s, motion.outcome, motion.reason, motion.done)"));
  stage.applying = false;
  stage.tick();
  const std::uint32_t sequence = stage.sender.last_sequence();
  const SetpointId knee = stage.robot.catalog.setpoints.find("posture.l_knee.position_rad").value();
  stage.snapshot.refusals[0] = {.sequence = sequence + 1, .reason = RefusalReason::too_old};  // of somebody else
  stage.snapshot.refusals[1] = {.sequence = sequence,
                                .kind = CommandKind::set_point,
                                .reason = RefusalReason::out_of_range,
                                .index = knee,
                                .value = 3};
  stage.snapshot.transactions_refused = 2;
  stage.snapshot.transactions_applied = sequence + 2;  // later ones were applied
  stage.play(3);
  const std::string why = "posture.l_knee.position_rad = 3 is outside its range 0..2.35 rad";
  CHECK(stage.said() == "moving nil\nrefused by the control engine, all commands of that tick: " + why +
                            "\nnil refused " + why + "\n0.01 refused " + why + " true\n");
  CHECK(stage.behavior->transactions_refused() == 1);
}

TEST_CASE("the outcome of a motion tells how it ended") {
  Stage stage(
      in_run("local a, b = m.posture:move('lean', { time_s = 0.05 }), m.posture:move('stand', { time_s = 1 })\n"
             "print(a.outcome) a:wait() print(a.outcome, b.outcome, a.reason) b:cancel() print(b.outcome)"));
  stage.play(20);
  CHECK(stage.said() == "moving\ndone moving nil\ncancelled\n");
}

TEST_CASE("a parameter is read back as it is, by its name") {
  Stage stage(
      in_run("print(m.posture:parameter 'l_knee.kp_Nm_per_rad') m.posture:set_parameter('l_knee.kp_Nm_per_rad', 70)\n"
             "m:wait(0.01) print(m.posture:parameter 'l_knee.kp_Nm_per_rad')\n"
             "print(pcall(m.posture.parameter, m.posture, 'l_knee.kp_Nm'))"));
  stage.tick();
  const ParameterId kp = stage.robot.catalog.parameters.find("posture.l_knee.kp_Nm_per_rad").value();
  CHECK(stage.robot.catalog.parameters.set(kp, 70));
  stage.play(3);
  CHECK(stage.said().find("100\n70\nfalse ") == 0);
  CHECK(stage.said().find("'posture' has no parameter 'l_knee.kp_Nm', did you mean 'l_knee.kp_Nm_per_rad'?") !=
        std::string::npos);
}

TEST_CASE("m:clear_faults() is a command among the others of its tick, in their order") {
  Stage stage(in_run("print(m:clear_faults()) m.posture:move({ l_knee = 1 }, { time_s = 1 })"));
  stage.play(2);
  CHECK(stage.said() == "true\n");
  REQUIRE(stage.applied.size() == 3);
  CHECK(stage.applied[1].kind == CommandKind::clear_faults);
  CHECK(stage.applied[2].kind == CommandKind::set_point);
}

TEST_CASE("a motion whose transaction is never applied expires") {
  Stage stage(in_run("print(m.posture:move('lean', { time_s = 0.5 }):wait()) print(s.time_s)"));
  stage.applying = false;
  stage.play(300);
  CHECK(stage.said() == "nil expired\n1.51\n");
}

TEST_CASE("a pose moves the joints of the object and leaves the others") {
  Stage stage(in_run("m.posture:move('lean', { time_s = 1 })"));
  stage.tick();
  CHECK(stage.commands(CommandKind::set_point) == 12);
}

TEST_CASE("k.pose gives a copy of a pose, which may be changed and moved to") {
  Stage stage(
      "local k = require 'kadans'\nlocal pose = k.pose 'lean'\npose.l_ankle_roll, pose.r_ankle_roll, pose.l_knee = "
      "nil, nil, 0.5\n"
      "return k.behavior 'test' { k.state 'a' { enter = function(m) m.posture:move(pose, { time_s = 1 }) "
      "print(k.pose('lean').l_knee) end } }");
  stage.tick();
  CHECK(stage.said() == "0.1\n");
  CHECK(stage.commands(CommandKind::set_point) == 12);
}

TEST_CASE("the snapshot shows the robot, refilled each tick in the same tables") {
  Stage stage(
      "local k = require 'kadans'\nreturn k.behavior 'test' { enter = function(m, s) m.vars.knee = 1 end,\nk.state 'a' "
      "{ during = function(m, s)\n"
      "print(s.time_s, s.tick, s.joints.l_knee.position_rad, s.joints.l_knee.velocity_rad_s, "
      "s.joints.l_knee.effort_Nm,\n"
      "s.base.roll_rad, s.base.pitch_rad, s.base.yaw_rad, s.base.tilt_rad, s.base.height_m, "
      "s.base.angular_velocity_rad_s.y,\n"
      "s.feet.left.contact, s.feet.right.force_N, s.feet.left.cop_x_m, s.feet.left.cop_y_m, s.safety.level, "
      "s.safety.faults) end } }");
  stage.tick();
  stage.snapshot.joints.joints[3] = {.position_rad = 1, .velocity_rad_s = 2, .effort_Nm = 3};
  stage.snapshot.status.base.roll_rad = 4;
  stage.snapshot.status.base.pitch_rad = 5;
  stage.snapshot.status.base.yaw_rad = 6;
  stage.snapshot.status.base.tilt_rad = 7;
  stage.snapshot.status.base.height_m = 8;
  stage.snapshot.status.base.angular_velocity_rad_s[1] = 9;
  stage.snapshot.status.feet[0] = {.contact = true, .force_N = 10, .cop_x_m = 11, .cop_y_m = 12};
  stage.snapshot.status.feet[1].force_N = 13;
  stage.snapshot.status.safety.level = SafetyLevel::hold;
  stage.snapshot.status.safety.fault_count = 14;
  stage.tick();
  CHECK(stage.said() ==
        "0 0 0 0 0 0 0 0 0 0 0 false 0 0 0 normal 0\n"
        "0.01 10 1 2 3 4 5 6 7 8 9 true 13 11 12 hold 14\n");
}

TEST_CASE("a field that a script begins to read late is of this tick, and of each that follows") {
  Stage stage(
      "local k = require 'kadans'\nlocal n = 0\nreturn k.behavior 'test' { k.state 'a' { during = function(m, s)\n"
      "n = n + 1\nlocal knee = s.joints.l_knee\n"
      "if n == 1 then print(knee.position_rad) else print(knee.effort_Nm, knee.position_rad) end end } }");
  for (int i = 1; i <= 3; ++i) {
    stage.snapshot.joints.joints[3] = {.position_rad = 1.0 * i, .velocity_rad_s = 0, .effort_Nm = 10.0 * i};
    stage.tick();
  }
  CHECK(stage.said() == "1\n20 2\n30 3\n");
}
