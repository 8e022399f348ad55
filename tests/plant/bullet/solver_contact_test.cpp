// What the plant's own solver must do by physics alone: friction within its cone and against the sliding, no energy out
// of nothing, drives within their limits, nothing allocated.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/dynamics.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::test;

namespace {

constexpr double friction = 0.5;

Robot cube(double ground_friction) {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.surfaces.push_back({"box", friction});
  robot.settings.ground_friction = ground_friction;
  return robot;
}

double energy_J(const PlantTruth& truth) {
  constexpr double mass_kg = 2, inertia_kg_m2 = 2 * 0.08 / 12;
  double v2 = 0, w2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    v2 += truth.base_velocity_m_s[i] * truth.base_velocity_m_s[i];
    w2 += truth.base_angular_velocity_rad_s[i] * truth.base_angular_velocity_rad_s[i];
  }
  return mass_kg * g * truth.base.position_m[2] + mass_kg * v2 / 2 + inertia_kg_m2 * w2 / 2;
}

// Of all links, from the robot's own mass matrix.
double energy_J(Dynamics& dynamics, const PlantTruth& truth) {
  const std::span<const double> position_rad(truth.position_rad.data(), truth.joint_count);
  const std::span<const double> velocity_rad_s(truth.velocity_rad_s.data(), truth.joint_count);
  dynamics.update(position_rad, velocity_rad_s,
                  {truth.base, truth.base_velocity_m_s, truth.base_angular_velocity_rad_s});
  Eigen::VectorXd v(static_cast<Eigen::Index>(dynamics.size()));
  for (Eigen::Index i = 0; i < 3; ++i) {
    v[i] = truth.base_velocity_m_s[static_cast<std::size_t>(i)];
    v[i + 3] = truth.base_angular_velocity_rad_s[static_cast<std::size_t>(i)];
  }
  for (std::size_t i = 0; i < truth.joint_count; ++i) v[static_cast<Eigen::Index>(6 + i)] = velocity_rad_s[i];
  return 0.5 * v.dot(dynamics.mass_matrix() * v) + dynamics.potential_energy_J();
}

double beyond_cone_N(const Vec3& force_N, double most) {
  return std::hypot(force_N[0], force_N[1]) - most * force_N[2];
}

}  // namespace

TEST_CASE("What slides is braked alike and straight in every direction") {
  for (const double heading_rad : {0.0, 0.4, M_PI / 4, 1.9, -2.5}) {
    CAPTURE(heading_rad);
    const Robot robot = cube(1);
    BulletWorld plant(robot.model, robot.settings, 1);
    const double force_N = 2 * 1500;
    plant.push(0, {force_N * std::cos(heading_rad), force_N * std::sin(heading_rad), 0}, {});
    run(plant, 50);
    const Vec3 before = plant.truth().base_velocity_m_s;
    run(plant, 100);
    const Vec3 after = plant.truth().base_velocity_m_s;
    const double lost_m_s = std::hypot(before[0] - after[0], before[1] - after[1]);
    CHECK(lost_m_s == doctest::Approx(friction * g * 0.1).epsilon(0.01));
    CHECK(std::atan2(after[1], after[0]) == doctest::Approx(heading_rad).epsilon(0.01));
  }
}

TEST_CASE("A falling TULip's feet never push against the cone of friction") {
  const Robot robot = tulip(Drives::rigid);
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  double worst_N = 0, pressed_N = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i > 300 && i < 450) plant.push(0, {40, 60, 0}, {});
    hold.tick(plant);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      const Vec3& force_N = plant.truth().foot_force_N[foot];
      worst_N = std::max(worst_N, beyond_cone_N(force_N, 0.8));
      pressed_N = std::max(pressed_N, force_N[2]);
    }
  }
  CHECK(plant.truth().base.position_m[2] < 0.5);
  CHECK(pressed_N > 100);
  CHECK(worst_N < 1e-9);
}

TEST_CASE("A cube thrown at the ground never has more energy than it began with, with and without friction") {
  RandomStream random(1, "throws");
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    Robot robot = cube(i % 3);
    robot.settings.stand_on_ground = false;
    robot.settings.base.position_m[2] = 0.4;
    robot.settings.base.orientation = normalized({random.normal(), random.normal(), random.normal(), random.normal()});
    BulletWorld plant(robot.model, robot.settings, 1);
    const auto push_N = [&] { return 2000 * random.normal(); };
    plant.push(0, {push_N(), push_N(), push_N()}, {0.02 * random.normal(), 0.02 * random.normal(), 0});
    plant.step(ms);
    const double begun_J = energy_J(plant.truth());
    double most_J = 0;
    for (int k = 0; k < 1000; ++k) {
      plant.step(ms);
      most_J = std::max(most_J, energy_J(plant.truth()));
    }
    CHECK(most_J < begun_J * 1.001);
    CHECK(energy_J(plant.truth()) < begun_J);
  }
}

TEST_CASE("A limp TULip that is let fall never has more energy than it began with, and comes to rest") {
  for (const double lean_rad : {0.3, -0.4}) {
    CAPTURE(lean_rad);
    Robot robot = tulip(Drives::rigid);
    for (DriveSettings& drive : robot.settings.drives) drive = {};
    robot.settings.stand_on_ground = false;
    robot.settings.base = {.position_m = {0, 0, 1.1}, .orientation = normalized({1, 0.3 * lean_rad, lean_rad / 2, 0})};
    BulletWorld plant(robot.model, robot.settings, 1);
    Dynamics dynamics(robot.model, {.base = Dynamics::Base::floating});
    const double begun_J = energy_J(dynamics, plant.truth());
    double most_J = 0, before_J = begun_J, largest_gain_J = 0;
    for (int i = 0; i < 3000; ++i) {
      plant.step(ms);
      const double now_J = energy_J(dynamics, plant.truth());
      most_J = std::max(most_J, now_J);
      largest_gain_J = std::max(largest_gain_J, now_J - before_J);
      before_J = now_J;
    }
    CHECK(most_J < begun_J * 1.001);
    CHECK(largest_gain_J < 0.005 * begun_J);
    CHECK(before_J < 0.5 * begun_J);
  }
}

TEST_CASE("A TULip that collapses under a tonne does not rebound, and its motors keep to their lines") {
  Robot robot = tulip(Drives::rigid);
  robot.settings.world.payloads = {
      {.name = "tonne", .link = "torso", .point_m = {0, 0, 0.1}, .mass_kg = 990, .from_s = 0.2}};
  BulletWorld plant(robot.model, robot.settings, 1);
  JointHold hold(robot);
  double up_m_s = 0, motor_excess_Nm = 0, residual_at_rest_m_s = 0;
  for (int i = 0; i < 2500; ++i) {
    hold.tick(plant);
    const PlantTruth& truth = plant.truth();
    if (i > 500) up_m_s = std::max(up_m_s, truth.base_velocity_m_s[2]);
    if (i > 2000) residual_at_rest_m_s = std::max(residual_at_rest_m_s, truth.residual_m_s);
    for (std::size_t j = 0; j < truth.joint_count; ++j)
      motor_excess_Nm = std::max(motor_excess_Nm, std::abs(truth.motor_torque_Nm[j]) - truth.motor_torque_max_Nm[j]);
  }
  CHECK(up_m_s < 0.1);
  CHECK(motor_excess_Nm < 0.01);
  CHECK(residual_at_rest_m_s <= 1e-3);
}

TEST_CASE("Contacts that would go around in a circle are settled: a limp TULip's tumbles leave next to nothing open") {
  std::size_t steps = 0, open = 0;
  for (const double lean_rad : {0.3, -0.4, 1.5}) {
    Robot robot = tulip(Drives::rigid);
    for (DriveSettings& drive : robot.settings.drives) drive = {};
    robot.settings.stand_on_ground = false;
    robot.settings.base = {.position_m = {0, 0, 1.1}, .orientation = normalized({1, 0.3 * lean_rad, lean_rad / 2, 0})};
    BulletWorld plant(robot.model, robot.settings, 1);
    for (int i = 0; i < 3000; ++i, ++steps) {
      plant.step(ms);
      if (plant.truth().residual_m_s > 1e-3) ++open;
    }
  }
  CHECK(open < steps / 100);
}

TEST_CASE("Servos that reach their torque limit stay there, and servos that do not hold their law") {
  Robot robot = pendulum(1, 0.5, 0.3);
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.drives = {{.torque_max_Nm = 2,
                            .rotor_inertia_kg_m2 = 0.02,
                            .position_gain_Nm_per_rad = 4000,
                            .velocity_gain_Nms_per_rad = 800}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(position(1.2));  // needs 4.6 Nm
  double most_Nm = 0;
  for (int i = 0; i < 3000; ++i) {
    plant.step(ms);
    SensorFrame sensors;
    plant.read(sensors);
    most_Nm = std::max(most_Nm, std::abs(sensors.joints[0].motor_effort_Nm));
  }
  CHECK(most_Nm == doctest::Approx(2).epsilon(1e-9));
  CHECK(plant.truth().position_rad[0] < 0.9);
  plant.write(position(0.2));  // needs 0.97 Nm
  run(plant, 3000);
  const double sag_rad = 0.5 * g * std::sin(0.2) / 4000;
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.2 - sag_rad).epsilon(1e-5));
}

TEST_CASE("Nothing is allocated once a second has passed, lying with a ball beside it") {
  Robot robot = tulip(Drives::rigid);
  robot.settings.base.orientation = {std::sqrt(0.5), 0, std::sqrt(0.5), 0};
  robot.settings.world.objects.push_back(
      {.name = "ball", .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4}, .pose = {.position_m = {0.1, 0.5, 0.1}}});
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 1000);
  const testing::AllocationCount heap;
  run(plant, 2000);
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(plant.truth().contact_count > 3);
}
