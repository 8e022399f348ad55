#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

// A link too heavy to move: the rotor alone swings on its spring.
Robot fixed_link(const DriveSettings& drive) {
  Robot robot = pendulum(1e3, 0, 1e9);
  robot.settings.drives = {drive};
  return robot;
}

// Deflection of a damped oscillator after a step of torque.
double step_response_rad(double t_s, double torque_Nm, double inertia, double spring, double damping) {
  const double w0 = std::sqrt(spring / inertia), zeta = damping / (2 * std::sqrt(spring * inertia));
  const double wd = w0 * std::sqrt(1 - zeta * zeta);
  return torque_Nm / spring *
         (1 - std::exp(-zeta * w0 * t_s) * (std::cos(wd * t_s) + zeta * w0 / wd * std::sin(wd * t_s)));
}

}  // namespace

TEST_CASE("A series elastic drive answers a torque step as its formula says") {
  for (const double spring : {50.0, 200.0, 1000.0}) {
    Robot robot = fixed_link({.torque_max_Nm = 20,
                              .rotor_inertia_kg_m2 = 0.02,
                              .viscous_Nms_per_rad = 0.1,
                              .spring_Nm_per_rad = spring,
                              .spring_damping_Nms_per_rad = 0.1});
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(effort(10));
    SensorFrame sensors;
    double worst = 0;
    for (int i = 1; i <= 300; ++i) {
      plant.step(ms);
      plant.read(sensors);
      const double exact = step_response_rad(1e-3 * i, 10, 0.02, spring, 0.2);
      worst = std::max(worst, std::abs(sensors.joints[0].motor_position_rad - exact));
    }
    const double radians_per_step = 1e-3 * std::sqrt(spring / 0.02);
    CHECK(worst < 0.7 * radians_per_step * 10 / spring);  // half a step of phase, at the steepest point
    run(plant, 3000);
    CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(10).epsilon(1e-3));
  }
}

TEST_CASE("A stiff series spring carries the rotor along: acceleration = torque / (link + rotor)") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {
      {.torque_max_Nm = 3, .rotor_inertia_kg_m2 = 0.03, .spring_Nm_per_rad = 3000, .spring_damping_Nms_per_rad = 2}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(2));
  run(plant, 200);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.2 * 2 / 0.05).epsilon(0.01));
}

TEST_CASE("An undamped series spring neither gains nor loses energy") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {{.torque_max_Nm = 10, .rotor_inertia_kg_m2 = 0.01, .spring_Nm_per_rad = 300}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(10));
  run(plant, 10);
  plant.write(effort(0));
  SensorFrame sensors;
  const auto largest_deflection_rad = [&](int steps) {
    double largest = 0;
    for (int i = 0; i < steps; ++i) {
      plant.step(ms);
      plant.read(sensors);
      largest = std::max(largest, std::abs(sensors.joints[0].motor_position_rad - sensors.joints[0].position_rad));
    }
    return largest;
  };
  const double early = largest_deflection_rad(200);
  run(plant, 20000);
  CHECK(largest_deflection_rad(200) == doctest::Approx(early).epsilon(0.02));
}

TEST_CASE("Springs from 50 to 3000 Nm/rad are stable on a rotor of 0.01 kg m2 and a bare foot") {
  for (const double spring : {50.0, 300.0, 1000.0, 3000.0}) {
    Robot robot = pendulum(0.4, 0, 0.0037);
    robot.settings.drives = {{.torque_max_Nm = 20,
                              .rotor_inertia_kg_m2 = 0.01,
                              .spring_Nm_per_rad = spring,
                              .spring_damping_Nms_per_rad = 0.1}};
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(effort(5));
    run(plant, 5);
    plant.write(effort(-5));
    run(plant, 5);
    plant.write(effort(0));
    run(plant, 2000);
    CHECK(std::abs(plant.truth().drive_torque_Nm[0]) < 0.05);
  }
}

TEST_CASE("A rotor too light for the step takes smaller ones") {
  Robot robot = fixed_link({.torque_max_Nm = 20,
                            .rotor_inertia_kg_m2 = 2e-4,
                            .spring_Nm_per_rad = 3000,
                            .spring_damping_Nms_per_rad = 0.05});
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(10));
  run(plant, 2000);
  CHECK(plant.truth().drive_torque_Nm[0] == doctest::Approx(10).epsilon(1e-3));
}

TEST_CASE("Position mode of an elastic drive is the rotor's: the link settles a deflection away") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.drives = {{.torque_max_Nm = 20,
                            .rotor_inertia_kg_m2 = 0.02,
                            .spring_Nm_per_rad = 100,
                            .spring_damping_Nms_per_rad = 0.5,
                            .position_gain_Nm_per_rad = 9000,
                            .velocity_gain_Nms_per_rad = 180}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(position(1));
  run(plant, 4000);
  const double load_Nm = g * 0.1 * std::sin(plant.truth().position_rad[0]);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(1 - load_Nm / 100 - load_Nm / 9000).epsilon(1e-4));
}

TEST_CASE("The speed-torque line holds for a rotor behind a spring") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {{.torque_max_Nm = 4,
                            .velocity_max_rad_s = 8,
                            .knee_velocity_rad_s = 4,
                            .rotor_inertia_kg_m2 = 0.01,
                            .spring_Nm_per_rad = 200,
                            .spring_damping_Nms_per_rad = 0.5}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(4));
  run(plant, 1500);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(8).epsilon(0.01));
}

TEST_CASE("A transmission that is hit carries more than its motor gives, and the motor stays on its line") {
  const DriveSettings drive{.torque_max_Nm = 3,
                            .velocity_max_rad_s = 8,
                            .knee_velocity_rad_s = 4.8,
                            .rotor_inertia_kg_m2 = 0.02,
                            .spring_Nm_per_rad = 3000,
                            .spring_damping_Nms_per_rad = 1};
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.settings.drives = {drive};
  BulletWorld plant(robot.model, robot.settings, 1);
  SensorFrame sensors;
  double rotor_rad = 0, rotor_rad_s = 0, most_on_joint_Nm = 0;
  for (int i = 0; i < 600; ++i) {
    plant.write(effort(i / 100 % 2 == 0 ? 50 : -50));
    if (i % 90 == 80) plant.push(1, {400, 0, 0}, {0, 0, -0.1});
    plant.step(ms);
    plant.read(sensors);
    const double before_rad_s = rotor_rad_s;
    rotor_rad_s = 1e3 * (sensors.joints[0].motor_position_rad - rotor_rad);
    rotor_rad = sensors.joints[0].motor_position_rad;
    const double motor_Nm = plant.truth().motor_torque_Nm[0], sign = motor_Nm < 0 ? -1 : 1;
    const double slower_rad_s = std::min(sign * before_rad_s, sign * rotor_rad_s);
    const double allowed_Nm = 3 * std::clamp((8 - slower_rad_s) / (8 - 4.8), 0.0, 1.0);
    CHECK(std::abs(motor_Nm) <= allowed_Nm + 1e-6);
    CHECK(plant.truth().motor_torque_max_Nm[0] == doctest::Approx(allowed_Nm).epsilon(1e-6));
    most_on_joint_Nm = std::max(most_on_joint_Nm, std::abs(plant.truth().drive_torque_Nm[0]));
  }
  CHECK(most_on_joint_Nm > 2 * drive.torque_max_Nm);
}
