#include "kadans/control/switchover.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"

namespace switchover_test {

using namespace kadans;

namespace {

constexpr DriveLaw drive{.effort_max_Nm = 20, .position_gain_Nm_per_rad = 400, .velocity_gain_Nms_per_rad = 10};
constexpr double dt_s = 0.001;

struct Bench {
  Switchover switchover;
  JointStates joints;
  ActuationFrame before, after;

  explicit Bench(const SwitchSettings& settings = {}) : switchover({drive}, settings) {
    joints.count = before.joint_count = after.joint_count = 1;
    joints.joints[0] = {.position_rad = 0.5, .velocity_rad_s = 0, .effort_Nm = 0};
  }
  double torque_Nm(const ActuationFrame& frame) const {
    const double torque = drive_torque_Nm(drive, frame.joints[0], joints.joints[0].position_rad, 0);
    return std::clamp(torque, -drive.effort_max_Nm, drive.effort_max_Nm);
  }
  // The torque of each tick after the switch, the joint standing still.
  std::vector<double> fade(int ticks = 250) {
    switchover.begin(joints, dt_s, before, after);
    std::vector<double> torques;
    for (int i = 0; i < ticks; ++i) {
      ActuationFrame frame = after;
      switchover.apply(joints, dt_s, frame);
      torques.push_back(torque_Nm(frame));
    }
    return torques;
  }
};

JointActuation effort(double effort_Nm) { return {.effort_Nm = effort_Nm, .mode = ActuationMode::effort}; }
JointActuation position(double position_rad) { return {.position_rad = position_rad, .mode = ActuationMode::position}; }
JointActuation velocity(double velocity_rad_s) {
  return {.velocity_rad_s = velocity_rad_s, .mode = ActuationMode::velocity};
}
JointActuation impedance(double position_rad) {
  return {.position_rad = position_rad,
          .stiffness_Nm_per_rad = 90,
          .damping_Nms_per_rad = 3,
          .mode = ActuationMode::impedance};
}

}  // namespace

TEST_CASE("Across all modes the first torque is the last one, and after 0.2 s it is the new law's own") {
  const JointActuation laws[] = {effort(12),    effort(-60),  position(0.53), position(0.2), position(5),
                                 velocity(0.7), velocity(-9), impedance(0.6), impedance(9),  JointActuation{}};
  for (const JointActuation& before : laws) {
    for (const JointActuation& after : laws) {
      Bench bench;
      bench.before.joints[0] = before;
      bench.after.joints[0] = after;
      const auto torques = bench.fade();
      CHECK(torques.front() == doctest::Approx(bench.torque_Nm(bench.before)).epsilon(1e-9));
      CHECK(torques[201] == doctest::Approx(bench.torque_Nm(bench.after)));
    }
  }
}

TEST_CASE("What is absorbed is told as a share of the limit") {
  Bench bench;
  bench.before.joints[0] = effort(10);
  bench.after.joints[0] = effort(-4);
  (void)bench.fade();
  CHECK(bench.switchover.absorbed_share() == doctest::Approx(14.0 / 20));
}

TEST_CASE("From one end of the torque's range to the other, in any mode, no tick changes it by more than the bound") {
  const JointActuation ends[] = {effort(-60), effort(60), position(-4), position(5), velocity(-9), velocity(9)};
  for (const JointActuation& before : ends) {
    for (const JointActuation& after : ends) {
      for (const double step_max : {0.02, 0.004}) {
        Bench bench({.step_max = step_max});
        bench.before.joints[0] = before;
        bench.after.joints[0] = after;
        const auto torques = bench.fade(1000);
        double largest_Nm = 0;
        for (std::size_t i = 1; i < torques.size(); ++i) {
          largest_Nm = std::max(largest_Nm, std::abs(torques[i] - torques[i - 1]));
        }
        CHECK(largest_Nm <= step_max * drive.effort_max_Nm + 1e-9);
        CHECK(torques.back() == doctest::Approx(bench.torque_Nm(bench.after)));
      }
    }
  }
}

TEST_CASE("The fade takes the time it is given, and longer only where the bound of a tick's change wants it") {
  const auto ticks = [](const SwitchSettings& settings) {
    Bench bench(settings);
    bench.before.joints[0] = effort(20);
    bench.after.joints[0] = effort(-20);
    const auto torques = bench.fade(2000);
    return std::find(torques.begin(), torques.end(), -20.0) - torques.begin();
  };
  CHECK(ticks({}) == 200);
  CHECK(ticks({.fade_s = 0.5}) == 500);
  CHECK(ticks({.step_max = 0.01}) == 375);  // 2 limits, 1.875 times the mean slope
  CHECK(ticks({.step_max = 0.01, .fade_s = 0.001}) == 375);
}

TEST_CASE("A law that is not finite is passed on for the safety layer to stop") {
  Bench bench;
  bench.before.joints[0] = effort(10);
  bench.after.joints[0] = effort(std::numeric_limits<double>::quiet_NaN());
  bench.switchover.begin(bench.joints, dt_s, bench.before, bench.after);
  ActuationFrame frame = bench.after;
  bench.switchover.apply(bench.joints, dt_s, frame);
  CHECK(std::isnan(frame.joints[0].effort_Nm));
  frame.joints[0] = effort(1);
  bench.switchover.apply(bench.joints, dt_s, frame);
  CHECK(frame.joints[0].effort_Nm == 1);  // and leaves nothing behind
}

TEST_CASE("A switch allocates nothing") {
  Bench bench;
  const kadans::testing::AllocationCount heap;
  bench.switchover.begin(bench.joints, dt_s, bench.before, bench.after);
  bench.switchover.apply(bench.joints, dt_s, bench.after);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace switchover_test
