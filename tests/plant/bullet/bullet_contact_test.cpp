#include <algorithm>
#include <cmath>
#include <cstdint>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

using namespace kadans;
using namespace kadans::test;

namespace {

// The ground is level; a slope is gravity that leans.
Robot box_on_slope(double slope_rad, double box_friction, double ground_friction) {
  Robot robot = box(2, {0.2, 0.2, 0.1});
  robot.settings.gravity_m_s2 = {g * std::sin(slope_rad), 0, -g * std::cos(slope_rad)};
  robot.settings.surfaces.push_back({"box", box_friction});
  robot.settings.ground_friction = ground_friction;
  return robot;
}

// A torso whose two arms hang beside it and swing about x, inwards when positive for the left one.
Robot torso_with_arm(double gap_m) {
  Robot robot = pendulum(0.5, 0.18, 0.02);
  robot.model.links[0].collisions.push_back({"torso", "base", {{0, 0, -0.2}, {1, 0, 0, 0}}, Box{{0.16, 0.24, 0.4}}});
  robot.model.links[1].collisions.push_back({"arm", "arm", {{0, 0, -0.18}, {1, 0, 0, 0}}, Box{{0.04, 0.04, 0.36}}});
  Link shoulder;
  shoulder.name = "shoulder";
  shoulder.inertia = {.mass_kg = 0.1, .xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
  robot.model.links.insert(robot.model.links.begin() + 1, shoulder);
  robot.model.joints[0].origin.position_m = {0, 0.12 + gap_m + 0.02, 0};
  robot.model.joints[0].axis = {1, 0, 0};
  Joint swing = robot.model.joints[0];
  swing.name = "arm";
  swing.parent = 1;
  swing.origin = {};
  robot.model.joints.push_back(swing);
  robot.settings.drives.resize(2, DriveSettings{.torque_max_Nm = 5});
  robot.settings.encoders.resize(2);
  robot.settings.position_rad.resize(2);
  robot.settings.base.position_m = {0, 0, 3};
  return robot;
}

}  // namespace

TEST_CASE("On soft ground a box sinks by its weight over the stiffness of its four corners, and comes to rest") {
  for (const double stiffness_N_per_m : {2000.0, 1e6}) {
    Robot robot = box(4, {0.22, 0.1, 0.03});
    robot.settings.ground_stiffness_N_per_m = stiffness_N_per_m;
    robot.settings.ground_damping_Ns_per_m = 30;
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 2000);
    CHECK(0.015 - plant.truth().base.position_m[2] == doctest::Approx(4 * g / (4 * stiffness_N_per_m)).epsilon(1e-3));
    CHECK(std::abs(plant.truth().base_velocity_m_s[2]) < 1e-5);
    CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-3));
  }
}

TEST_CASE("Soft ground without damping swings a box at its own frequency, and gains no energy") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.ground_stiffness_N_per_m = 1000;
  BulletWorld plant(robot.model, robot.settings, 1);
  double lowest_m = 1;
  int lowest_tick = 0;
  for (int tick = 0; tick < 150; ++tick) {
    plant.step(1'000'000);
    if (plant.truth().base.position_m[2] >= lowest_m) continue;
    lowest_m = plant.truth().base.position_m[2];
    lowest_tick = tick;
  }
  CHECK(0.001 * lowest_tick == doctest::Approx(M_PI / std::sqrt(4 * 1000 / 4.0)).epsilon(0.05));  // half a period
  CHECK(0.015 - lowest_m < 2 * 4 * g / (4 * 1000) + 1e-4);
  CHECK(0.015 - lowest_m > 1.8 * 4 * g / (4 * 1000));
}

TEST_CASE("Soft ground keeps its damping under what bounces elsewhere: a critically damped box does not hop") {
  for (const double restitution : {0.0, 0.6}) {
    Robot robot = box(4, {0.22, 0.1, 0.03});
    robot.settings.ground_restitution = restitution;
    robot.settings.ground_stiffness_N_per_m = 10000;
    robot.settings.ground_damping_Ns_per_m = 200;  // of four corners: critical for 4 kg
    robot.settings.stand_on_ground = false;
    robot.settings.base.position_m = {0, 0, 0.215};
    BulletWorld plant(robot.model, robot.settings, 1);
    double highest_m = 0;
    for (int tick = 0; tick < 1000; ++tick) {
      plant.step(ms);
      if (tick > 210) highest_m = std::max(highest_m, plant.truth().base.position_m[2]);
    }
    CHECK(highest_m < 0.016);
  }
}

TEST_CASE("A ground that gives speed back lets a box hop, a hard one without does not") {
  for (const double restitution : {0.0, 0.6}) {
    Robot robot = box(4, {0.22, 0.1, 0.03});
    robot.settings.ground_restitution = restitution;
    robot.settings.stand_on_ground = false;
    robot.settings.base.position_m = {0, 0, 0.215};
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 203);  // it has just landed at 1.98 m/s
    CHECK(plant.truth().base_velocity_m_s[2] == doctest::Approx(restitution * 1.98).epsilon(0.05).scale(1));
  }
}

TEST_CASE("A box rests at its own height and its foot sensors carry m g") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  BulletWorld plant(robot.model, robot.settings, 1);
  CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.015).epsilon(1e-9));
  run(plant, 500);
  CHECK(std::abs(plant.truth().base.position_m[2] - 0.015) < 1e-6);
  CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-4));
  SensorFrame sensors;
  plant.read(sensors);
  double sum_N = 0;
  for (const double force_N : sensors.feet[0].force_N) {
    CHECK(force_N == doctest::Approx(g).epsilon(1e-2));
    sum_N += force_N;
  }
  CHECK(sum_N == doctest::Approx(4 * g).epsilon(1e-4));
}

TEST_CASE("A heavy landing is not cut off: the ground stops any impulse") {
  Robot robot = box(500, {0.3, 0.3, 0.3});
  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 1.15};
  BulletWorld plant(robot.model, robot.settings, 1);
  double lowest_m = 1;
  for (int i = 0; i < 1500; ++i) {
    plant.step(ms);
    lowest_m = std::min(lowest_m, plant.truth().base.position_m[2]);
  }
  CHECK(lowest_m > 0.149);
  CHECK(std::abs(plant.truth().base_velocity_m_s[2]) < 1e-3);
}

TEST_CASE("A box stays on a slope just under the friction angle and slides just over it") {
  const double friction = 0.8 * 0.5, angle_rad = std::atan(friction);  // the product of both surfaces
  Robot under = box_on_slope(angle_rad - 0.01, 0.8, 0.5);
  BulletWorld stays(under.model, under.settings, 1);
  run(stays, 1000);
  CHECK(std::abs(stays.truth().base.position_m[0]) < 1e-3);

  Robot over = box_on_slope(angle_rad + 0.05, 0.8, 0.5);
  BulletWorld slides(over.model, over.settings, 1);
  run(slides, 1000);
  const double slope_rad = angle_rad + 0.05;
  const double acceleration = g * (std::sin(slope_rad) - friction * std::cos(slope_rad));
  CHECK(slides.truth().base_velocity_m_s[0] == doctest::Approx(acceleration).epsilon(0.02));
}

TEST_CASE("Friction never exceeds mu N, in whatever direction it acts along an axis") {
  for (const double direction : {-1.0, 1.0}) {
    Robot robot = box_on_slope(0.6 * direction, 1, 0.3);
    BulletWorld plant(robot.model, robot.settings, 1);
    for (int i = 0; i < 200; ++i) {
      plant.step(ms);
      const Vec3& force = plant.truth().foot_force_N[0];
      CHECK(std::abs(force[0]) <= 0.3 * force[2] * (1 + 1e-9));
    }
  }
}

TEST_CASE("A box that stands under a swaying load does not creep") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.surfaces.push_back({"box", 0.8});
  BulletWorld plant(robot.model, robot.settings, 1);
  for (int i = 0; i < 10000; ++i) {
    plant.push(0, {3 * std::sin(0.01 * i), 2 * std::cos(0.013 * i), 0}, {0, 0, 0.1});
    plant.step(ms);
  }
  CHECK(std::hypot(plant.truth().base.position_m[0], plant.truth().base.position_m[1]) < 1e-4);
}

TEST_CASE("An arm that swings in stops at the torso, and swings through where the two may pass or no mass is between") {
  enum class Case : std::uint8_t { stops, off, passes, neighbours };
  for (const Case of : {Case::stops, Case::off, Case::passes, Case::neighbours}) {
    Robot robot = torso_with_arm(0.03);
    if (of == Case::neighbours) {
      robot.model.links[1].inertia = {};
      robot.model.joints[0].axis = {0, 1, 0};
    }
    robot.settings.self_collision = of != Case::off;
    if (of == Case::passes)
      robot.settings.passing.emplace_back(robot.model.links.back().name, robot.model.links.front().name);
    for (const TouchingAt at : {TouchingAt::zero, TouchingAt::start})
      CHECK(touching_links(robot.model, robot.settings, at).empty());
    BulletWorld plant(robot.model, robot.settings, 1);
    ActuationFrame inwards;
    inwards.joint_count = 2;
    inwards.joints[1] = {.effort_Nm = -0.5, .mode = ActuationMode::effort};
    double furthest_rad = 0;
    for (int i = 0; i < 600; ++i) {
      plant.write(inwards);
      plant.step(ms);
      furthest_rad = std::min(furthest_rad, plant.truth().position_rad[0] + plant.truth().position_rad[1]);
    }
    if (of == Case::stops) {
      CHECK(furthest_rad < -0.02);
      CHECK(furthest_rad > -0.15);  // 3 cm at the hand
    } else {
      CHECK(furthest_rad < -1);
    }
  }
}

TEST_CASE("A child swings through its parent: what a joint holds together does not collide") {
  Robot robot = pendulum(0.5, 0.18, 0.02);
  robot.model.links[0].collisions.push_back({"post", "base", {{0, 0, 0.3}, {1, 0, 0, 0}}, Box{{0.1, 0.1, 0.3}}});
  robot.model.links[1].collisions.push_back({"arm", "arm", {{0, 0, -0.18}, {1, 0, 0, 0}}, Box{{0.04, 0.04, 0.3}}});
  robot.drive().torque_max_Nm = 1;
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(0.1));
  run(plant, 2000);
  CHECK(plant.truth().position_rad[0] == doctest::Approx(0.1 / 0.02 * 2 * 2 / 2).epsilon(0.01));  // over the top
}

TEST_CASE("Links that overlap at the zero pose, grandparent and grandchild, leave each other alone") {
  Robot robot = torso_with_arm(-0.01);  // the arm reaches 1 cm into the torso
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 200);
  CHECK(std::abs(plant.truth().position_rad[0]) < 1e-9);
  CHECK(std::abs(plant.truth().position_rad[1]) < 1e-9);
}

TEST_CASE("Spheres and cylinders rest on the ground where they touch it") {
  Robot ball = box(1, {0.1, 0.1, 0.1});
  ball.model.links[0].collisions[0].shape = Sphere{0.05};
  BulletWorld round(ball.model, ball.settings, 1);
  run(round, 500);
  CHECK(round.truth().base.position_m[2] == doctest::Approx(0.05).epsilon(1e-4));
  Robot drum = box(1, {0.1, 0.1, 0.1});
  drum.model.links[0].collisions[0].shape = Cylinder{0.05, 0.1};
  drum.settings.base.orientation = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
  BulletWorld lying(drum.model, drum.settings, 1);
  run(lying, 500);
  CHECK(lying.truth().base.position_m[2] == doctest::Approx(0.05).epsilon(1e-4));
  CHECK(lying.truth().foot_force_N[0][2] == doctest::Approx(g).epsilon(1e-3));
}
