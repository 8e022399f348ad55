#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

Robot limited_arm(const DriveSettings& drive) {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.model.joints[0].type = JointType::revolute;
  robot.model.joints[0].lower_rad = -0.5;
  robot.model.joints[0].upper_rad = 1.0;
  robot.settings.drives = {drive};
  return robot;
}

}  // namespace

TEST_CASE("Joint limits hold under full torque and at speed, and throw nothing back") {
  const DriveSettings bare{.torque_max_Nm = 25};
  const DriveSettings rotor{
      .torque_max_Nm = 25, .rotor_inertia_kg_m2 = 0.03, .viscous_Nms_per_rad = 0.1, .coulomb_Nm = 0.2};
  const DriveSettings elastic{
      .torque_max_Nm = 25, .rotor_inertia_kg_m2 = 0.02, .spring_Nm_per_rad = 200, .spring_damping_Nms_per_rad = 0.5};
  for (const DriveSettings& drive : {bare, rotor, elastic}) {
    for (const double sign : {-1.0, 1.0}) {
      CAPTURE(drive.rotor_inertia_kg_m2);
      CAPTURE(sign);
      Robot robot = limited_arm(drive);
      BulletWorld plant(robot.model, robot.settings, 1);
      plant.write(effort(25 * sign));
      double lowest = 0, highest = 0;
      for (int i = 0; i < 1000; ++i) {
        plant.step(ms);
        lowest = std::min(lowest, plant.truth().position_rad[0]);
        highest = std::max(highest, plant.truth().position_rad[0]);
      }
      CHECK(lowest > -0.5 - 2e-3);
      CHECK(highest < 1.0 + 2e-3);
      CHECK(plant.truth().position_rad[0] == doctest::Approx(sign > 0 ? 1.0 : -0.5).epsilon(2e-3));
      CHECK(std::abs(plant.truth().velocity_rad_s[0]) < 0.05);
    }
  }
}

TEST_CASE("A limit only pushes: the joint leaves it freely") {
  Robot robot = limited_arm({.torque_max_Nm = 25});
  robot.settings.position_rad = {1.0};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(-0.2));
  run(plant, 100);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(-0.2 * 0.1 / 0.02).epsilon(1e-3));
}

TEST_CASE("A joint that starts 0.1 rad beyond its limit comes back, slowly") {
  Robot robot = limited_arm({.torque_max_Nm = 25});
  robot.settings.position_rad = {-0.6};
  BulletWorld plant(robot.model, robot.settings, 1);
  double fastest = 0;
  for (int i = 0; i < 1000; ++i) {
    plant.step(ms);
    fastest = std::max(fastest, plant.truth().velocity_rad_s[0]);
  }
  CHECK(plant.truth().position_rad[0] > -0.501);
  CHECK(fastest < 1);
}

TEST_CASE("A prismatic joint slides along its axis and stops at its limit") {
  Robot robot = limited_arm({.torque_max_Nm = 10});
  robot.model.joints[0].type = JointType::prismatic;
  robot.settings.feet.push_back({.link = "arm"});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(2));
  run(plant, 500);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(2 * 0.5 * 0.5 / 2).epsilon(0.01));
  CHECK(plant.truth().feet[0].position_m[1] == doctest::Approx(plant.truth().position_rad[0]));
  run(plant, 2000);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(1.0).epsilon(1e-3));
}
