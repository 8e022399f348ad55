// What the whole-body object says before a motion, and how it keeps its balance in one that it was not asked about.
#include <cmath>

#include <doctest/doctest.h>

#include "control/body/body_clash.h"
#include "stand_bench.h"

namespace body_foresight_test {

using namespace kadans;
using kadans::test::HandBench;
using kadans::test::leg_robot;
using kadans::test::StandBench;

using Why = Foresight::Why;

TEST_CASE("what cannot be reached is told before it moves, with how far it is, and what can be is not") {
  StandBench bench;
  bench.run(300);
  const double z_m = bench.setpoint("com_z_m"), x_m = bench.setpoint("com_x_m");
  CHECK(bench.foresee("com_z_m", z_m - 0.05).by == 0);
  CHECK(bench.foresee("com_x_m", x_m + 0.03).by == 0);
  // The legs are 0.55 m long and were bent by 0.6 rad: 0.02 m are left.
  const Foresight::Miss high = bench.foresee("com_z_m", z_m + 0.10);
  CHECK(high.by == doctest::Approx(0.08).epsilon(0.1));
  CHECK(high.channel == bench.catalog.setpoints[bench.id("com_x_m")].channel);
  // The soles end 0.1 m before and behind the feet, and balance_m is 0.03 m.
  CHECK(bench.foresee("com_x_m", 0.15).by > 0.04);
  CHECK(bench.foresee("com_x_m", 0.065).by == 0);
}

TEST_CASE("a motion that would topple the body is refused with the time that it needs, and taken with that time") {
  StandBench bench;
  bench.run(300);
  const double x_m = bench.setpoint("com_x_m");
  const Foresight::Miss quick = bench.foresee("com_x_m", x_m + 0.04, 0.1);
  CHECK(quick.why == Why::topple);
  CHECK(quick.by > 0.15);
  CHECK(quick.by < 1.5);
  CHECK(quick.after_s >= 0);
  CHECK(quick.after_s < 0.1);
  CHECK(bench.foresee("com_x_m", x_m + 0.04, quick.by).why == Why::none);
  // The pendulum over the soles says about the same: its centre of pressure is c - c'' z / g, which is farthest before
  // the end, where it slows down most.
  const double peak_m_s2 = 5.77 * 0.04 / (quick.by * quick.by);
  CHECK(x_m + 0.036 + peak_m_s2 * bench.setpoint("com_z_m") / 9.81 == doctest::Approx(0.09).epsilon(0.15));
}

TEST_CASE("a joint that would have to be faster than it can is named with the time that it needs") {
  StandBench bench;
  bench.run(300);
  bench.set("velocity_share", 0.05);
  const Foresight::Miss fast = bench.foresee("com_z_m", bench.setpoint("com_z_m") - 0.06, 0.6);
  CHECK(fast.why == Why::speed);
  CHECK(fast.by > 0.6);
  CHECK(bench.model.joints[fast.joint].name.ends_with("_knee"));
}

TEST_CASE("a motion on whose way the trunk leans more than it may is refused with how far") {
  StandBench bench;
  bench.run(300);
  CHECK(bench.foresee("trunk.pitch_rad", 0.2, 3).why == Why::none);
  bench.set("tilt_max_rad", 0.1);
  const Foresight::Miss leans = bench.foresee("trunk.pitch_rad", 0.2, 3);
  CHECK(leans.why == Why::tilt);
  CHECK(leans.by == doctest::Approx(0.2).epsilon(0.05));
}

TEST_CASE("what acts at once is judged by how quick the task's gain makes it") {
  StandBench bench;
  bench.run(300);
  const double x_m = bench.setpoint("com_x_m");
  CHECK(bench.foresee("com_x_m", x_m - 0.08, 0).why == Why::topple);
  bench.set("com.gain_per_s", 0.6);
  CHECK(bench.foresee("com_x_m", x_m - 0.08, 0).why == Why::none);
}

TEST_CASE("on one foot whose ankle has no motor and too weak a spring it says that it cannot stand") {
  RobotModel loose = leg_robot();
  for (const std::size_t roll : {1U, 6U}) loose.joints[roll].effort_max_Nm = 0;
  StandBench bench(loose);
  bench.set("passive_Nm_per_rad", 1);
  bench.run(100);
  const Foresight::Miss miss = bench.foresee("contact.right", 0);
  CHECK(miss.why == Why::bear);
  CHECK(miss.joint == 1);
  CHECK(miss.by > 5);
  bench.set("passive_Nm_per_rad", 400);
  CHECK(bench.foresee("contact.right", 0).why != Why::bear);
  StandBench stiff;
  stiff.run(100);
  CHECK(stiff.foresee("contact.right", 0).why != Why::bear);
}

TEST_CASE("a hand whose way leads through a stretched arm's shoulder is refused, one beside it is not") {
  HandBench bench;
  bench.start();
  bench.run(300);
  const Vec3 at = bench.hand_m();
  const auto ask = [&](double x_m, double z_m) {
    const std::uint32_t x = bench.catalog.setpoints[*bench.catalog.setpoints.find("it.hand_right_x_m")].channel;
    const std::array goals{Foresight::Goal{x, x_m}, Foresight::Goal{x + 2, z_m}};
    bench.snapshot.joints = bench.joints;
    return bench.object->foresight()->miss({goals, 2}, bench.snapshot).why;
  };
  CHECK(ask(at[0] + 0.1, at[2] + 0.1) == Why::none);
  CHECK(ask(-at[0], -at[2]) != Why::none);
}

TEST_CASE("the capture point stays over the soles whatever the tasks ask for, and the target is reached later") {
  StandBench bench;
  bench.run(300);
  const double x_m = bench.setpoint("com_x_m"), rate_per_s = std::sqrt(9.81 / bench.setpoint("com_z_m"));
  bench.move("com_x_m", x_m + 0.045, 0.05);
  double farthest_m = 0, before_m = x_m;
  for (int i = 0; i < 300; ++i) {
    bench.run(10);
    const double com_m = bench.signal("com_x_m");
    if (i > 0) farthest_m = std::max(farthest_m, com_m + (com_m - before_m) / 0.01 / rate_per_s);
    before_m = com_m;
  }
  CHECK(farthest_m < 0.1 - 0.03 + 0.005);
  CHECK(bench.signal("com_x_m") == doctest::Approx(x_m + 0.045).epsilon(0.01));
  CHECK(bench.signal("failures") == 0);
}

TEST_CASE("links that hit each other are found, neighbours and those that always overlap do not count") {
  RobotModel model = leg_robot();
  const auto shaped = [&](const char* link, const Vec3& size_m, const Vec3& at_m) {
    model.links[*model.find_link(link)].collisions.push_back({.pose = {at_m, {1, 0, 0, 0}}, .shape = Box{size_m}});
  };
  shaped("torso", {0.2, 0.4, 0.3}, {0, 0, 0.05});
  shaped("l_yaw", {0.05, 0.05, 0.05}, {0, 0, 0.13});  // a neighbour, in the torso
  shaped("l_thigh", {0.08, 0.08, 0.2}, {0, 0, -0.13});
  shaped("r_thigh", {0.08, 0.08, 0.2}, {0, 0, -0.13});
  BodyClash clash(model);
  BodyGeometry posture(model, true);
  const auto found = [&](double hip_roll_rad, double hip_pitch_rad) {
    posture.position_rad[1] = hip_roll_rad;
    posture.position_rad[2] = hip_pitch_rad;
    posture.update();
    return clash.find(posture);
  };
  clash.begin(posture);
  CHECK_FALSE(found(0, 0).found());
  const BodyClash::Pair legs = found(-0.7, 0);
  CHECK(model.links[legs.link].name == "l_thigh");
  CHECK(model.links[legs.other].name == "r_thigh");
  CHECK(found(0, -2.4).found());
  CHECK_FALSE(found(0, -1.2).found());
  clash.begin(posture);
  found(0, -2.4);
  clash.begin(posture);
  CHECK_FALSE(found(0, -2.4).found());  // it began so
}

TEST_CASE("the trunk of a biped bends to the point at which it is to look, and its feet stay") {
  StandBench bench(leg_robot(), {{"gaze", "torso"}});
  bench.run(300);
  bench.set("trunk.weight", 0);
  const double left_m = bench.setpoint("foot_left.position_x_m"), z_m = bench.setpoint("gaze_z_m");
  CHECK(bench.setpoint("gaze_x_m") == doctest::Approx(1).epsilon(0.05));
  bench.move("gaze_x_m", 2, 1);
  bench.move("gaze_z_m", z_m - 0.3, 1);
  bench.run(2500);
  CHECK(bench.setpoint("foot_left.position_x_m") == doctest::Approx(left_m).epsilon(0.001));
  CHECK(bench.signal("failures") == 0);
  const double pitch_rad = -(bench.joints.joints[2].position_rad + bench.joints.joints[3].position_rad +
                             bench.joints.joints[4].position_rad);
  CHECK(pitch_rad == doctest::Approx(std::atan2(0.3, 2.0)).epsilon(0.05));
}

TEST_CASE("a hand that idles has its set-points where it is, also after a motion and its weight 0") {
  HandBench bench;
  const auto shown = [&](const char* name) {
    SetpointState at;
    (void)bench.object->setpoint_state(bench.catalog.setpoints[*bench.catalog.setpoints.find(name)].channel, at);
    return at.value;
  };
  bench.start();
  bench.run(100);
  bench.set("posture_weight", 1);
  bench.set_point("shoulder.position_rad", 0.6, 0.5);
  bench.run(3000);
  CHECK(shown("it.hand_right_x_m") == doctest::Approx(bench.hand_m()[0]).epsilon(0.01));
  bench.set_point("hand_right_x_m", bench.hand_m()[0] + 0.1, 0.5);
  bench.run(1000);
  bench.set("hand_right.weight", 0);
  bench.run(3000);
  CHECK(bench.joints.joints[0].position_rad == doctest::Approx(0.6).epsilon(0.02));
  CHECK(shown("it.hand_right_x_m") == doctest::Approx(bench.hand_m()[0]).epsilon(0.01));
}

TEST_CASE("without tasks the posture leads alone, from where the joints are, until a task is moved again") {
  StandBench bench;
  bench.run(300);
  const double z_m = bench.setpoint("com_z_m");
  bench.move("com_z_m", z_m - 0.08, 0.8);
  bench.run(1500);
  const double low_rad = bench.joints.joints[3].position_rad;
  CHECK(low_rad > 0.9);
  bench.move("tasks", 0, 0);
  bench.run(20);
  CHECK(bench.joints.joints[3].position_rad == doctest::Approx(low_rad).epsilon(0.01));
  for (const std::string side : {"l", "r"}) {
    bench.move(side + "_hip_pitch.position_rad", -0.3, 1);
    bench.move(side + "_knee.position_rad", 0.6, 1);
    bench.move(side + "_ankle_pitch.position_rad", -0.3, 1);
  }
  bench.run(3000);
  CHECK(bench.joints.joints[3].position_rad == doctest::Approx(0.6).epsilon(0.01));
  CHECK(bench.setpoint("com_z_m") == doctest::Approx(z_m).epsilon(0.01));
  CHECK(bench.setpoint("tasks") == 0);
  bench.move("com_z_m", z_m - 0.05, 0.8);
  bench.run(1500);
  CHECK(bench.setpoint("tasks") == 1);
  CHECK(bench.signal("com_z_m") == doctest::Approx(z_m - 0.05).epsilon(0.005));
  CHECK(bench.signal("failures") == 0);
}

}  // namespace body_foresight_test
