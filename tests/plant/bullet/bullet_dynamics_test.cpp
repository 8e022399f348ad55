#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include "kadans/model/dynamics.h"
#include "kadans/model/kinematics.h"
#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

Robot falling_box() {
  Robot robot = box(3, {0.2, 0.2, 0.2});
  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 100};
  return robot;
}

// Seconds between two passages through zero in the same direction, times interpolated.
double measured_period_s(BulletWorld& plant, int steps) {
  double last = plant.truth().position_rad[0], first_s = -1, period_s = 0;
  int passages = 0;
  for (int i = 1; i <= steps; ++i) {
    plant.step(ms);
    const double now = plant.truth().position_rad[0];
    if (last < 0 && now >= 0) {
      const double at_s = 1e-3 * (i - now / (now - last));
      if (first_s < 0)
        first_s = at_s;
      else
        period_s = (at_s - first_s) / ++passages;
    }
    last = now;
  }
  return period_s;
}

// Complete elliptic integral of the first kind by the arithmetic-geometric mean, modulus sin(amplitude / 2).
double exact_period_s(double small_period_s, double amplitude_rad) {
  double a = 1, b = std::cos(amplitude_rad / 2);
  for (int i = 0; i < 8; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return small_period_s / a;
}

Robot swinging(double amplitude_rad) {
  Robot robot = pendulum(2, 0.5, 0.6);
  robot.settings.gravity_m_s2 = {0, 0, -g};
  robot.settings.position_rad = {amplitude_rad};
  return robot;
}

}  // namespace

TEST_CASE("A box in free fall gains g t and nothing brakes it") {
  Robot robot = falling_box();
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 800);
  CHECK(plant.truth().base_velocity_m_s[2] == doctest::Approx(-g * 0.8).epsilon(1e-9));
  CHECK(100 - plant.truth().base.position_m[2] == doctest::Approx(g * 0.8 * 0.8 / 2).epsilon(2e-3));
  CHECK(100 - plant.truth().base.position_m[2] == doctest::Approx(g * 1e-6 * 800 * 801 / 2).epsilon(1e-9));
}

TEST_CASE("A step is exactly as long as asked for, however short or long") {
  Robot robot = falling_box();
  BulletWorld fine(robot.model, robot.settings, 1), coarse(robot.model, robot.settings, 1);
  run(fine, 1000, ms / 4);
  run(coarse, 10, 25 * ms);
  CHECK(fine.truth().base_velocity_m_s[2] == doctest::Approx(-g * 0.25).epsilon(1e-9));
  CHECK(coarse.truth().base_velocity_m_s[2] == doctest::Approx(-g * 0.25).epsilon(1e-9));
}

TEST_CASE("A small pendulum swings with the period of its formula, and never falls asleep") {
  const double small_s = 2 * std::numbers::pi * std::sqrt(0.6 / (2 * g * 0.5));
  Robot robot = swinging(0.002);
  BulletWorld plant(robot.model, robot.settings, 1);
  CHECK(measured_period_s(plant, 20000) == doctest::Approx(small_s).epsilon(1e-4));
  double largest = 0;
  for (int i = 0; i < 2000; ++i) {
    plant.step(ms);
    largest = std::max(largest, std::abs(plant.truth().position_rad[0]));
  }
  CHECK(largest == doctest::Approx(0.002).epsilon(0.01));
}

TEST_CASE("A wide pendulum swings with the period of the elliptic integral") {
  const double small_s = 2 * std::numbers::pi * std::sqrt(0.6 / (2 * g * 0.5));
  Robot robot = swinging(2.5);
  BulletWorld plant(robot.model, robot.settings, 1);
  CHECK(measured_period_s(plant, 20000) == doctest::Approx(exact_period_s(small_s, 2.5)).epsilon(1e-3));
}

TEST_CASE("A pendulum keeps its energy over 20 s") {
  Robot robot = swinging(1.5);
  BulletWorld plant(robot.model, robot.settings, 1);
  const auto energy_J = [&] {
    const PlantTruth& truth = plant.truth();
    return 0.3 * truth.velocity_rad_s[0] * truth.velocity_rad_s[0] - 2 * g * 0.5 * std::cos(truth.position_rad[0]);
  };
  const double at_start = energy_J();
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    plant.step(ms);
    worst = std::max(worst, std::abs(energy_J() - at_start));
  }
  CHECK(worst < 0.01 * 2 * g * 0.5);
}

TEST_CASE("Drives inside a free robot move its parts and not its centre of mass") {
  Robot robot = tumbling_chain();
  BulletWorld plant(robot.model, robot.settings, 1);
  const Vec3 com = plant.truth().com_m;
  ActuationFrame actuation;
  actuation.joint_count = 2;
  for (int i = 0; i < 1000; ++i) {
    actuation.joints[0] = {.effort_Nm = i < 500 ? 0.3 : -0.3, .mode = ActuationMode::effort};
    actuation.joints[1] = {.effort_Nm = i < 300 ? -0.2 : 0.2, .mode = ActuationMode::effort};
    plant.write(actuation);
    plant.step(ms);
  }
  CHECK(std::abs(plant.truth().velocity_rad_s[0]) + std::abs(plant.truth().position_rad[0]) > 0.5);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(plant.truth().com_velocity_m_s[i]) < 2e-3);
    CHECK(std::abs(plant.truth().com_m[i] - com[i]) < 1e-3);
  }
}

// Links without mass between joints, as of universal joints, on a fixed and on a free base.
TEST_CASE("A robot with links without mass moves as its equations of motion say, with both solvers") {
  for (const bool fixed : {true, false}) {
    for (const auto solver : {ContactSolver::tree, ContactSolver::stock}) {
      Robot robot = tumbling_chain();
      robot.model.links.push_back(robot.model.links[2]);
      robot.model.links.push_back(robot.model.links[1]);
      robot.model.links[1].inertia = robot.model.links[3].inertia = {};
      for (const std::size_t parent : {1U, 3U}) {
        Joint joint = robot.model.joints[1];
        joint.name = "further" + std::to_string(parent);
        joint.parent = parent;
        joint.axis = {0.6, 0.8, 0};
        robot.model.joints.push_back(joint);
        robot.model.links[robot.model.joints.size()].name = joint.name;
        robot.settings.drives.emplace_back();
        robot.settings.encoders.emplace_back();
        robot.settings.drives.back().torque_max_Nm = 1;
      }
      robot.settings.solver = solver;
      robot.settings.fixed_base = fixed;
      robot.settings.gravity_m_s2 = {0, 0, -g};
      robot.settings.position_rad = {0.3, -0.4, 0.5, 0.6};
      BulletWorld plant(robot.model, robot.settings, 1);
      Dynamics dynamics(robot.model, {.base = fixed ? Dynamics::Base::fixed : Dynamics::Base::floating});
      ActuationFrame actuation;
      actuation.joint_count = 4;
      for (std::size_t j = 0; j < 4; ++j) actuation.joints[j] = {.effort_Nm = 0.2, .mode = ActuationMode::effort};
      for (int i = 0; i < 50; ++i) {
        const PlantTruth before = plant.truth();
        dynamics.update(before.position_rad, before.velocity_rad_s,
                        {before.base, before.base_velocity_m_s, before.base_angular_velocity_rad_s});
        Eigen::VectorXd force = -dynamics.bias();
        force.tail(4).array() += 0.2;
        const Eigen::VectorXd wanted = dynamics.mass_matrix().ldlt().solve(force);
        plant.write(actuation);
        plant.step(ms);
        for (std::size_t j = 0; j < 4; ++j) {
          const double found = (plant.truth().velocity_rad_s[j] - before.velocity_rad_s[j]) / 1e-3;
          CHECK(found == doctest::Approx(wanted[wanted.size() - 4 + static_cast<Eigen::Index>(j)]).epsilon(1e-8));
        }
      }
      CHECK(std::abs(plant.truth().velocity_rad_s[0]) > 0.05);
    }
  }
}

TEST_CASE("Bullet's frames are the model's: base, feet and centre of mass agree with its own kinematics") {
  Robot robot = tumbling_chain();
  robot.settings.feet.push_back({.link = "end"});
  robot.settings.position_rad = {0.7, -1.1};
  robot.settings.base.orientation = normalized({0.9, 0.1, -0.3, 0.2});
  BulletWorld plant(robot.model, robot.settings, 1);
  ActuationFrame actuation;
  actuation.joint_count = 2;
  actuation.joints[1] = {.effort_Nm = 0.5, .mode = ActuationMode::effort};
  plant.write(actuation);
  run(plant, 300);
  const PlantTruth& truth = plant.truth();
  Kinematics kinematics(robot.model);
  kinematics.update({truth.position_rad.data(), truth.joint_count}, truth.base);
  const Vec3 com = kinematics.com_m();
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(truth.feet[0].position_m[i] == doctest::Approx(kinematics.link(2).position_m[i]).epsilon(1e-9));
    CHECK(truth.com_m[i] == doctest::Approx(com[i]).epsilon(1e-9));
  }
  const Quat turn = multiply(conjugate(truth.feet[0].orientation), kinematics.link(2).orientation);
  CHECK(std::abs(turn[0]) == doctest::Approx(1).epsilon(1e-9));
}

TEST_CASE("A free joint spins as fast as it is driven: no silent clamp at 100 rad/s") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive().torque_max_Nm = 10;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(4));
  run(plant, 1000);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(200).epsilon(1e-6));
}

TEST_CASE("A push acts once, at its point") {
  Robot robot = falling_box();
  robot.settings.gravity_m_s2 = {0, 0, 0};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.push(0, {6, 0, 0}, {0, 0, 0.1});
  run(plant, 5);
  CHECK(plant.truth().com_velocity_m_s[0] == doctest::Approx(6 * 1e-3 / 3).epsilon(1e-9));
  const double inertia_kg_m2 = 3 * 0.08 / 12;
  CHECK(plant.truth().base_angular_velocity_rad_s[1] == doctest::Approx(6 * 0.1 * 1e-3 / inertia_kg_m2).epsilon(1e-6));
  CHECK_THROWS_AS(plant.push(1, {1, 0, 0}, {}), std::invalid_argument);
  CHECK_THROWS_AS(plant.push(0, {NAN, 0, 0}, {}), std::invalid_argument);
}

TEST_CASE("A full inertia tensor answers a torque with its inverse") {
  Robot robot = falling_box();
  robot.settings.gravity_m_s2 = {0, 0, 0};
  Inertia& inertia = robot.model.links[0].inertia;
  inertia.xx = 0.05;
  inertia.yy = 0.03;
  inertia.zz = 0.06;
  inertia.xy = 0.02;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.push(0, {0, 0, 10}, {0, 0.5, 0});  // together a torque of 10 Nm about x
  plant.push(0, {0, 0, -10}, {0, -0.5, 0});
  plant.step(ms);
  const double determinant = 0.05 * 0.03 - 0.02 * 0.02;
  CHECK(plant.truth().base_angular_velocity_rad_s[0] == doctest::Approx(0.01 * 0.03 / determinant).epsilon(1e-6));
  CHECK(plant.truth().base_angular_velocity_rad_s[1] == doctest::Approx(-0.01 * 0.02 / determinant).epsilon(1e-6));
  CHECK(std::abs(plant.truth().base_angular_velocity_rad_s[2]) < 1e-9);
}
