#include <cmath>

#include <doctest/doctest.h>

#include "kadans/plant/ideal_world.h"
#include "small_robots.h"

using namespace kadans;
using namespace kadans::test;

TEST_CASE("The ideal plant's joint is a double integrator of its rotor's inertia") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive().rotor_inertia_kg_m2 = 0.5;
  IdealWorld plant(robot.model, robot.settings);
  plant.write(effort(2));
  run(plant, 100);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.1 * 2 / 0.5));
  CHECK(plant.truth().position_rad[0] == doctest::Approx(4 * 0.1 * 0.1 / 2).epsilon(0.02));
  CHECK(plant.truth().drive_torque_Nm[0] == 2);
}

TEST_CASE("The ideal plant obeys position and velocity at once, within the joint's limits") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.model.joints[0].type = JointType::revolute;
  robot.model.joints[0].lower_rad = -1;
  robot.model.joints[0].upper_rad = 1;
  IdealWorld plant(robot.model, robot.settings);
  plant.write(position(0.4));
  plant.step(ms);
  CHECK(plant.truth().position_rad[0] == 0.4);
  plant.write(velocity(-2));
  run(plant, 100);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.2));
  plant.write(position(7));
  plant.step(ms);
  CHECK(plant.truth().position_rad[0] == 1);
  CHECK(plant.truth().velocity_rad_s[0] == 0);
}

TEST_CASE("The ideal plant's joint swings on the spring that impedance mode asks for, and comes to rest at its end") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive().rotor_inertia_kg_m2 = 0.5;
  IdealWorld plant(robot.model, robot.settings);
  plant.write(impedance(0.4, 50, 0));
  run(plant, 157);  // a quarter of the period, 2 pi sqrt(J / k)
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.4).epsilon(0.02));
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.4 * std::sqrt(50 / 0.5)).epsilon(0.05));
  plant.write(impedance(0.4, 50, 10));
  run(plant, 2000);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.4).epsilon(1e-3));
}

TEST_CASE("The ideal plant's coupled joints follow their drives, whose rotors are all that moves") {
  Robot robot = neck();
  robot.drive(0).rotor_inertia_kg_m2 = 0.5;
  robot.drive(1).rotor_inertia_kg_m2 = 0.25;
  IdealWorld plant(robot.model, robot.settings);
  const JointActuation tilt{.effort_Nm = 3, .mode = ActuationMode::effort}, pan{.mode = ActuationMode::effort};
  plant.write(both(tilt, pan));  // 1.5 Nm of each drive
  run(plant, 100);
  const double left_rad_s = 0.1 * 1.5 / 0.5, right_rad_s = 0.1 * 1.5 / 0.25;
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx((left_rad_s + right_rad_s) / 2));
  CHECK(plant.truth().velocity_rad_s[1] == doctest::Approx((left_rad_s - right_rad_s) / 2));
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(3));
  CHECK(plant.truth().motor_torque_Nm[1] == doctest::Approx(1.5));
  SensorFrame sensors;
  plant.read(sensors);
  CHECK(sensors.joints[0].motor_effort_Nm == doctest::Approx(3));
  CHECK(sensors.joints[1].motor_effort_Nm == doctest::Approx(0));
  plant.write(both({.position_rad = 0.4, .mode = ActuationMode::position},
                   {.position_rad = -0.7, .mode = ActuationMode::position}));
  plant.step(ms);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.4));
  CHECK(plant.truth().position_rad[1] == doctest::Approx(-0.7));
}

TEST_CASE("The ideal plant's sensors count up, show its state and stand upright") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.position_rad = {0.3};
  IdealWorld plant(robot.model, robot.settings);
  SensorFrame before, after;
  plant.read(before);
  plant.step(ms);
  plant.read(after);
  CHECK(before.joint_count == 1);
  CHECK(before.joints[0].position_rad == 0.3);
  CHECK(before.imu.acceleration_m_s2[2] == doctest::Approx(g));
  CHECK(after.joints[0].sequence == before.joints[0].sequence + 1);
  CHECK(after.time_ns == ms);
}

TEST_CASE("The ideal plant takes no number that is not finite, and hashes its state") {
  Robot robot = pendulum(1, 0.1, 0.02);
  IdealWorld plant(robot.model, robot.settings), other(robot.model, robot.settings);
  plant.write(effort(NAN));
  run(plant, 10);
  run(other, 10);
  CHECK(plant.truth().position_rad[0] == 0);
  CHECK(state_hash(plant) == state_hash(other));
  other.write(effort(1));
  run(plant, 1);
  run(other, 1);
  CHECK(state_hash(plant) != state_hash(other));
}
