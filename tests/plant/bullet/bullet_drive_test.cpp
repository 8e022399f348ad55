#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

constexpr double link_kg_m2 = 0.02;

Robot driven_arm(const DriveSettings& drive) {
  Robot robot = pendulum(1, 0.1, link_kg_m2);
  robot.settings.drives = {drive};
  return robot;
}

}  // namespace

TEST_CASE("A drive gives at most torque_max, in both directions") {
  Robot robot = driven_arm({.torque_max_Nm = 3});
  for (const double sign : {-1.0, 1.0}) {
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(effort(sign * 50));
    run(plant, 100);
    CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(sign * 3 * 0.1 / link_kg_m2).epsilon(1e-6));
    CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(sign * 3));
  }
}

TEST_CASE("A rigid rotor's inertia moves with the joint: acceleration = torque / (link + rotor)") {
  Robot robot = driven_arm({.torque_max_Nm = 3, .rotor_inertia_kg_m2 = 0.03});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(2));
  run(plant, 100);
  const double acceleration = 2 / (link_kg_m2 + 0.03);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.1 * acceleration).epsilon(1e-6));
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(link_kg_m2 * acceleration).epsilon(1e-6));
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.joints[0].motor_effort_Nm == doctest::Approx(2));
}

TEST_CASE("The speed-torque line: full torque to the knee, none beyond no-load speed, full braking at any speed") {
  const DriveSettings drive{.torque_max_Nm = 4, .velocity_max_rad_s = 8, .knee_velocity_rad_s = 4};
  Robot robot = driven_arm(drive);
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(4));
  double fastest = 0;
  for (int i = 0; i < 400; ++i) {
    plant.step(ms);
    const double speed = plant.truth().velocity_rad_s[0];
    const double allowed_Nm = 4 * std::clamp((8 - speed) / 4, 0.0, 1.0);
    CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(allowed_Nm).epsilon(1e-6));
    fastest = std::max(fastest, speed);
  }
  CHECK(fastest > 7.9);
  CHECK(fastest <= 8);
  plant.write(effort(-4));
  plant.step(ms);
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(-4));
}

TEST_CASE("A position drive at 9000/180 holds still on a bare foot's inertia, and gives no more than its torque") {
  Robot robot = pendulum(0.4, 0.05, 0.0037);
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.drives = {{.torque_max_Nm = 20, .position_gain_Nm_per_rad = 9000, .velocity_gain_Nms_per_rad = 180}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(position(0.8));
  double largest_Nm = 0;
  for (int i = 0; i < 2000; ++i) {
    plant.step(ms);
    largest_Nm = std::max(largest_Nm, std::abs(plant.truth().drive_torque_Nm[0]));
  }
  const double load_Nm = 0.4 * g * 0.05 * std::sin(0.8);
  CHECK(largest_Nm <= 20 + 1e-9);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.8 - load_Nm / 9000).epsilon(1e-6));
  CHECK(std::abs(plant.truth().velocity_rad_s[0]) < 1e-6);
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(load_Nm).epsilon(1e-3));
}

TEST_CASE("A position drive's gain is in Nm/rad: it gives way by load / gain") {
  Robot robot = driven_arm({.torque_max_Nm = 20,
                            .rotor_inertia_kg_m2 = 0.02,
                            .position_gain_Nm_per_rad = 50,
                            .velocity_gain_Nms_per_rad = 2});
  robot.settings.gravity_m_s2 = {g, 0, 0};  // pulls along x: a load of -m g c cos(position) about y
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(position(0));
  run(plant, 3000);
  const double at_rad = plant.truth().position_rad[0];
  CHECK(std::abs(at_rad) == doctest::Approx(1 * g * 0.1 * std::cos(at_rad) / 50).epsilon(1e-4));
}

TEST_CASE("In impedance mode stiffness and damping are those that are asked, whatever the drive's own gains") {
  for (const double stiffness_Nm_per_rad : {20.0, 5000.0}) {
    Robot robot = driven_arm({.torque_max_Nm = 20,
                              .rotor_inertia_kg_m2 = 0.02,
                              .position_gain_Nm_per_rad = 300,
                              .velocity_gain_Nms_per_rad = 7});
    robot.settings.gravity_m_s2 = {g, 0, 0};
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(impedance(0, stiffness_Nm_per_rad, 2));
    double largest_Nm = 0;
    for (int i = 0; i < 4000; ++i) {
      plant.step(ms);
      largest_Nm = std::max(largest_Nm, std::abs(plant.truth().drive_torque_Nm[0]));
    }
    const double at_rad = plant.truth().position_rad[0];
    CHECK(std::abs(at_rad) == doctest::Approx(1 * g * 0.1 * std::cos(at_rad) / stiffness_Nm_per_rad).epsilon(1e-3));
    CHECK(largest_Nm <= 20 + 1e-9);
  }
}

TEST_CASE("A velocity drive cannot be asked beyond its no-load speed") {
  Robot robot = driven_arm({.torque_max_Nm = 5,
                            .velocity_max_rad_s = 6,
                            .knee_velocity_rad_s = 6,
                            .rotor_inertia_kg_m2 = 0.01,
                            .velocity_gain_Nms_per_rad = 100});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(velocity(20));
  run(plant, 2000);
  CHECK(plant.truth().velocity_rad_s[0] > 5.5);
  CHECK(plant.truth().velocity_rad_s[0] < 6.3);
}

TEST_CASE("A velocity drive keeps its speed under load, within its torque") {
  Robot robot = driven_arm({.torque_max_Nm = 5, .rotor_inertia_kg_m2 = 0.01, .velocity_gain_Nms_per_rad = 100});
  robot.settings.gravity_m_s2 = {0, 0, -g};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(velocity(2));
  run(plant, 300);
  for (int i = 0; i < 3000; ++i) {
    plant.step(ms);
    CHECK(std::abs(plant.truth().velocity_rad_s[0] - 2) < 0.02);
  }
}

TEST_CASE("Viscous friction brakes exponentially, dry friction linearly and to a stop") {
  Robot viscous = driven_arm({.torque_max_Nm = 10, .rotor_inertia_kg_m2 = 0.02, .viscous_Nms_per_rad = 0.1});
  BulletWorld slowing(viscous.model, viscous.settings, 1);
  slowing.write(effort(10));
  run(slowing, 20);
  slowing.write(effort(0));
  const double start = slowing.truth().velocity_rad_s[0];
  run(slowing, 400);
  CHECK(slowing.truth().velocity_rad_s[0] == doctest::Approx(start * std::exp(-0.4 * 0.1 / 0.04)).epsilon(0.01));

  Robot dry = driven_arm({.torque_max_Nm = 10, .rotor_inertia_kg_m2 = 0.02, .coulomb_Nm = 1});
  BulletWorld stopping(dry.model, dry.settings, 1);
  stopping.write(effort(9));
  run(stopping, 20);
  const double speed = stopping.truth().velocity_rad_s[0];
  CHECK(speed == doctest::Approx((9 - 1) * 0.02 / 0.04).epsilon(0.01));
  stopping.write(effort(0));
  run(stopping, 100);
  CHECK(stopping.truth().velocity_rad_s[0] == doctest::Approx(speed - 0.1 * 1 / 0.04).epsilon(0.01));
  run(stopping, 200);
  CHECK(std::abs(stopping.truth().velocity_rad_s[0]) < 1e-9);
  stopping.write(effort(0.9));  // too little to break loose
  run(stopping, 200);
  CHECK(std::abs(stopping.truth().velocity_rad_s[0]) < 1e-9);
}

TEST_CASE("The URDF's joint damping and friction add to the drive's") {
  Robot robot = driven_arm({.torque_max_Nm = 10});
  robot.model.joints[0].damping_Nms_per_rad = 0.5;
  robot.model.joints[0].friction_Nm = 1;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(3));
  run(plant, 2000);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx((3 - 1) / 0.5).epsilon(1e-3));
}

TEST_CASE("A passive joint's spring and damper are stable on an inertia far too light for explicit steps") {
  Robot robot = pendulum(0.4, 0, 3.6e-4);
  robot.settings.drives = {
      {.parallel_spring_Nm_per_rad = 25, .parallel_rest_rad = 0.1, .parallel_damping_Nms_per_rad = 0.6}};
  robot.settings.position_rad = {0.4};
  BulletWorld plant(robot.model, robot.settings, 1);
  double last = 0.4;
  for (int i = 0; i < 500; ++i) {
    plant.step(ms);
    CHECK(plant.truth().position_rad[0] <= last + 1e-12);  // overdamped: never back
    last = plant.truth().position_rad[0];
  }
  CHECK(last == doctest::Approx(0.1).epsilon(1e-3));
  CHECK(plant.truth().drive_torque_Nm[0] == 0);
}
