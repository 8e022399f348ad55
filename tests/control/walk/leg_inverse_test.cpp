#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/walk/led_leg.h"
#include "kadans/model/kinematics.h"
#include "leg_robot.h"

using namespace kadans;
using kadans::test::leg_robot;

namespace {

std::vector<JointAxis> all_axes(const RobotModel& model) {
  return joint_axes({.model = model, .joints = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}});
}

// Where the foot comes to be, in the base frame.
Pose foot(const RobotModel& model, const LegInverse::Angles& angles_rad, bool right) {
  std::array<double, 10> position_rad{};
  for (std::size_t i = 0; i < leg_joints; ++i) position_rad[i + (right ? 5 : 0)] = angles_rad[i];
  Kinematics kinematics(model);
  kinematics.update(position_rad);
  return kinematics.link(right ? 10 : 5);
}

}  // namespace

TEST_CASE("LegInverse puts the ankle where it is told") {
  const RobotModel model = leg_robot();
  const LegInverse left(model, all_axes(model), 5), right(model, all_axes(model), 10);
  for (const double yaw_rad : {-0.3, 0.0, 0.4}) {
    for (const Vec3 ankle_m : {Vec3{0.1, 0.05, -0.45}, Vec3{-0.2, 0.12, -0.4}, Vec3{0.3, -0.1, -0.35}}) {
      const LegInverse& leg = ankle_m[1] > 0 ? left : right;
      const Vec3 at_m = foot(model, leg.angles(ankle_m, yaw_rad), ankle_m[1] < 0).position_m;
      for (std::size_t i = 0; i < 3; ++i) CHECK(at_m[i] == doctest::Approx(ankle_m[i] + leg.hip_m()[i]));
    }
  }
}

TEST_CASE("LegInverse keeps the foot's pitch parallel to the base, and the knee bent forward") {
  const RobotModel model = leg_robot();
  const LegInverse leg(model, all_axes(model), 5);
  const LegInverse::Angles angles_rad = leg.angles({0.15, 0, -0.4}, 0);
  CHECK(angles_rad[knee] > 0);
  CHECK(angles_rad[hip_pitch] + angles_rad[knee] + angles_rad[ankle_pitch] == doctest::Approx(0));
  CHECK(roll_pitch_yaw(foot(model, angles_rad, false).orientation)[1] == doctest::Approx(0));
}

TEST_CASE("LegInverse brings a place too far within reach along its line") {
  const RobotModel model = leg_robot();
  const LegInverse leg(model, all_axes(model), 10);
  const Vec3 at_m = foot(model, leg.angles({0.5, 0, -0.6}, 0), true).position_m;
  const double x_m = at_m[0] - leg.hip_m()[0], z_m = at_m[2] - leg.hip_m()[2];
  CHECK(x_m / z_m == doctest::Approx(0.5 / -0.6));
  CHECK(std::hypot(x_m, z_m) == doctest::Approx(leg.longest_m()));
  CHECK(leg.longest_m() < test::thigh_m + test::shank_m);
}

TEST_CASE("LegInverse points a leg that may not be as long to the same place") {
  const RobotModel model = leg_robot();
  const LegInverse leg(model, all_axes(model), 5);
  const Vec3 ankle_m{0.15, 0.2, -0.4};
  const double far_m = length(ankle_m);
  for (const double most_m : {0.42, far_m, 0.6}) {
    const Vec3 at_m = difference(foot(model, leg.angles(ankle_m, 0.1, most_m), false).position_m, leg.hip_m());
    for (std::size_t i = 0; i < 3; ++i) CHECK(at_m[i] == doctest::Approx(ankle_m[i] * std::min(most_m / far_m, 1.0)));
  }
}

TEST_CASE("LegInverse finds its joints by their axes, and says what it misses") {
  RobotModel model = leg_robot();
  for (Joint& joint : model.joints) joint.name = "m" + joint.name.substr(2);
  const LegInverse leg(model, all_axes(model), 10);
  for (std::size_t i = 0; i < leg_joints; ++i) CHECK(leg.axis(i).joint == 5 + i);
  const std::vector<JointAxis> axes = joint_axes({.model = model, .joints = {0, 1, 2, 3}});
  CHECK_THROWS_WITH_AS(LegInverse(model, axes, 5), "the leg of l_foot needs a joint as ankle_pitch",
                       std::invalid_argument);
  model.joints[3].axis = {0, -1, 0};
  CHECK_THROWS_WITH_AS(LegInverse(model, all_axes(model), 5),
                       "the leg of l_foot: joint mknee turns the other way; z, x, y, y, y are needed",
                       std::invalid_argument);
  std::swap(model.joints[0].axis, model.joints[2].axis);
  model.joints[3].axis = {0, 1, 0};
  CHECK_THROWS_WITH_AS(LegInverse(model, all_axes(model), 5),
                       "the leg of l_foot: joint mhip_roll comes before mhip_pitch; from the hip on, z, x, y, y, y are "
                       "needed",
                       std::invalid_argument);
}
