// The robot among fixed objects and with balls and boxes that move.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "plant/small_robots.h"

namespace bullet_world_test {

using namespace kadans;
using namespace kadans::test;

namespace {

WorldObject object(const std::string& name, const WorldShape& shape, const Vec3& position_m) {
  WorldObject made;
  made.name = name;
  made.shape = shape;
  made.pose.position_m = position_m;
  return made;
}

// A foot of 4 kg.
Robot foot() {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.surfaces.push_back({"box", 0.8});
  return robot;
}

double pressure_N(BulletWorld& plant) {
  SensorFrame sensors;
  plant.read(sensors);
  double sum_N = 0;
  for (const double force_N : sensors.feet[0].force_N) sum_N += force_N;
  return sum_N;
}

}  // namespace

TEST_CASE("A robot starts on the box under it and stands there as on the ground") {
  Robot robot = foot();
  robot.settings.world.objects = {object("step", WorldBox{{1, 1, 0.2}}, {0, 0, 0.1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.215).epsilon(1e-9));
  for (int i = 0; i < 10000; ++i) {
    plant.push(0, {3 * std::sin(0.01 * i), 2 * std::cos(0.013 * i), 0}, {0, 0, 0.1});
    plant.step(ms);
  }
  run(plant, 200);
  const PlantTruth& truth = plant.truth();
  CHECK(std::hypot(truth.base.position_m[0], truth.base.position_m[1]) < 1e-4);
  CHECK(std::abs(truth.base.position_m[2] - 0.215) < 1e-6);
  CHECK(truth.foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-4));
  CHECK(pressure_N(plant) == doctest::Approx(4 * g).epsilon(1e-4));
  CHECK(truth.objects[0].force_N[2] == doctest::Approx(-4 * g).epsilon(1e-4));
  CHECK(truth.objects[0].links.test(0));
  CHECK(truth.ground_links.none());
}

TEST_CASE("A foot that overhangs a box by less than half stands, by more than half falls off") {
  for (const double overhang_m : {0.1, 0.12}) {
    Robot robot = foot();
    robot.settings.world.objects = {object("step", WorldBox{{1, 1, 0.2}}, {-0.5, 0, 0.1})};
    robot.settings.base.position_m = {overhang_m - 0.11, 0, 0};
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 1500);
    const double height_m = plant.truth().base.position_m[2];
    if (overhang_m < 0.11) {
      CHECK(height_m == doctest::Approx(0.215).epsilon(1e-4));
      CHECK(pressure_N(plant) == doctest::Approx(4 * g).epsilon(1e-3));
    } else {
      CHECK(height_m < 0.17);
    }
  }
}

TEST_CASE("A foot stands on a ramp of 5 degrees and its force is its weight") {
  const double incline_rad = 5 * M_PI / 180;
  for (const bool ground : {false, true}) {
    Robot robot = foot();
    if (ground) {
      robot.settings.world.slope_rad = incline_rad;
    } else {
      robot.settings.world.objects = {object("ramp", WorldRamp{2, 1, incline_rad}, {-1, 0, 0})};
    }
    robot.settings.base.orientation = from_axis_angle({0, 1, 0}, -incline_rad);
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 500);
    const Vec3 before = plant.truth().base.position_m;
    run(plant, 5000);
    const PlantTruth& truth = plant.truth();
    CHECK(length({truth.base.position_m[0] - before[0], truth.base.position_m[1] - before[1],
                  truth.base.position_m[2] - before[2]}) < 1e-5);
    CHECK(truth.foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-4));
    CHECK(std::abs(truth.foot_force_N[0][0]) < 0.01);
    CHECK(pressure_N(plant) == doctest::Approx(4 * g * std::cos(incline_rad)).epsilon(1e-4));
  }
}

TEST_CASE("On a ramp friction is the product of both surfaces") {
  const double friction = 0.8 * 0.5, angle_rad = std::atan(friction);
  for (const double more_rad : {-0.01, 0.05}) {
    Robot robot = foot();
    const double incline_rad = angle_rad + more_rad;
    robot.settings.world.objects = {object("ramp", WorldRamp{20, 2, incline_rad}, {-15, 0, 0})};
    robot.settings.world.objects[0].friction = 0.5;
    robot.settings.base.orientation = from_axis_angle({0, 1, 0}, -incline_rad);
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 1000);
    const double speed = length(plant.truth().base_velocity_m_s);
    if (more_rad < 0) {
      CHECK(speed < 1e-4);
    } else {
      CHECK(speed == doctest::Approx(g * (std::sin(incline_rad) - friction * std::cos(incline_rad))).epsilon(0.02));
    }
  }
}

TEST_CASE("Stairs carry at the height of each step") {
  Robot robot = foot();
  robot.settings.world.objects = {object("stairs", WorldStairs{3, 0.1, 0.3, 1}, {1, 0, 0})};
  for (int step = 1; step <= 3; ++step) {
    robot.settings.base.position_m = {1 + 0.3 * (step - 0.5), 0, 0};
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 300);
    CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.1 * step + 0.015).epsilon(1e-5));
  }
}

TEST_CASE("A wall stops what slides against it and feels its momentum") {
  Robot robot = box(2, {0.2, 0.2, 0.1});
  robot.settings.ground_friction = 0;
  robot.settings.world.objects = {object("wall", WorldWall{2, 1, 0.1}, {0.5, 0, 0})};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.push(0, {2000, 0, 0}, {0, 0, 0});  // 1 m/s
  double impulse_Ns = 0, furthest_m = 0;
  for (int i = 0; i < 1000; ++i) {
    plant.step(ms);
    impulse_Ns += plant.truth().objects[0].force_N[0] * 1e-3;
    furthest_m = std::max(furthest_m, plant.truth().base.position_m[0]);
  }
  CHECK(furthest_m == doctest::Approx(0.35).epsilon(1e-4));
  CHECK(std::abs(plant.truth().base_velocity_m_s[0]) < 1e-3);
  CHECK(impulse_Ns == doctest::Approx(2).epsilon(1e-3));
}

TEST_CASE("A box slides over the seam of two boxes as over one") {
  Robot robot = foot();
  robot.settings.surfaces[0].friction = 0;
  robot.settings.world.objects = {object("first", WorldBox{{1, 1, 0.2}}, {0, 0, 0.1}),
                                  object("second", WorldBox{{1, 1, 0.2}}, {1, 0, 0.1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 100);
  plant.push(0, {2000, 0, 0}, {0, 0, 0});  // 0.5 m/s
  run(plant, 2000);
  CHECK(plant.truth().base.position_m[0] == doctest::Approx(1).epsilon(1e-3));
  CHECK(plant.truth().base_velocity_m_s[0] == doctest::Approx(0.5).epsilon(1e-4));
}

TEST_CASE("A ball at rest stays where it lies, on the ground and on a box") {
  Robot robot = foot();
  robot.settings.world.objects = {object("table", WorldBox{{1, 1, 0.5}}, {3, 0, 0.25}),
                                  object("low", WorldBall{0.07, 0.4}, {1, 1, 0.07}),
                                  object("high", WorldBall{0.07, 0.4, 0.002, 0.6}, {3.1, 0.2, 0.57})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 5000);
  for (const std::size_t i : {1U, 2U}) {
    const Vec3& start_m = robot.settings.world.objects[i].pose.position_m;
    const Vec3& at_m = plant.truth().objects[i].pose.position_m;
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(at_m[k] - start_m[k]) < 1e-4);
    CHECK(length(plant.truth().objects[i].velocity_m_s) < 1e-3);
  }
}

TEST_CASE("A ball rolls down a slope with 5/7 g sin a") {
  const double slope_rad = 0.1;
  Robot robot = foot();
  robot.settings.world.slope_rad = slope_rad;
  robot.settings.world.objects = {object("ball", WorldBall{0.1, 0.45}, {5, 3, 0.1 / std::cos(slope_rad) + 0.5017})};
  robot.settings.base.orientation = from_axis_angle({0, 1, 0}, -slope_rad);
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 100);
  const double before = length(plant.truth().objects[0].velocity_m_s);
  run(plant, 1000);
  const ObjectTruth& ball = plant.truth().objects[0];
  CHECK(ball.velocity_m_s[0] < 0);
  CHECK(length(ball.velocity_m_s) - before == doctest::Approx(5.0 / 7 * g * std::sin(slope_rad)).epsilon(2e-3));
  CHECK(length(ball.angular_velocity_rad_s) == doctest::Approx(length(ball.velocity_m_s) / 0.1).epsilon(2e-3));
}

TEST_CASE("Rolling friction slows a ball by 5/7 g times lever arm over radius, and stops it for good") {
  Robot robot = foot();
  const double lever_m = 0.005, radius_m = 0.1;
  WorldBall shape{radius_m, 0.45, lever_m};
  shape.velocity_m_s = {1, 0, 0};
  robot.settings.world.objects = {object("ball", shape, {1, 1, radius_m})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 300);  // slides until it rolls
  const double before = plant.truth().objects[0].velocity_m_s[0];
  run(plant, 500);
  const double deceleration = 5.0 / 7 * g * lever_m / radius_m;
  CHECK(before - plant.truth().objects[0].velocity_m_s[0] == doctest::Approx(0.5 * deceleration).epsilon(0.01));
  run(plant, 3000);
  const double rest_m = plant.truth().objects[0].pose.position_m[0];
  run(plant, 1000);
  CHECK(std::abs(plant.truth().objects[0].pose.position_m[0] - rest_m) < 1e-6);
}

TEST_CASE("A ball that rolls askew to the world's axes is slowed as much, and goes straight on") {
  Robot robot = foot();
  WorldBall shape{.radius_m = 0.1, .mass_kg = 0.45, .rolling_friction_m = 0.005};
  const double heading_rad = 0.4;
  shape.velocity_m_s = {std::cos(heading_rad), std::sin(heading_rad), 0};
  robot.settings.world.objects = {object("ball", shape, {1, 1, 0.1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 300);
  const Vec3 before = plant.truth().objects[0].velocity_m_s;
  run(plant, 500);
  const Vec3& after = plant.truth().objects[0].velocity_m_s;
  CHECK(length(before) - length(after) == doctest::Approx(0.5 * 5.0 / 7 * g * 0.005 / 0.1).epsilon(0.01));
  run(plant, 3000);
  const Vec3& rest_m = plant.truth().objects[0].pose.position_m;
  CHECK(std::atan2(rest_m[1] - 1, rest_m[0] - 1) == doctest::Approx(heading_rad).epsilon(0.002));
}

TEST_CASE("A ball bounces with its restitution") {
  Robot robot = foot();
  robot.settings.world.objects = {object("ball", WorldBall{0.1, 0.45, 0, 0.8}, {1, 1, 1.1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  double down = 0, up = 0;
  for (int i = 0; i < 600; ++i) {
    plant.step(ms);
    const double velocity = plant.truth().objects[0].velocity_m_s[2];
    down = std::min(down, velocity);
    up = std::max(up, velocity);
  }
  CHECK(down == doctest::Approx(-std::sqrt(2 * g)).epsilon(0.01));
  CHECK(up == doctest::Approx(0.8 * std::sqrt(2 * g)).epsilon(0.02));
}

// Ground, ball and weight in a row: who falls on a ball gets back what the ball's restitution leaves, and no more.
TEST_CASE("What falls on a ball that lies on the ground bounces as the ball does, and is not flung up") {
  for (const double restitution : {0.0, 0.6}) {
    CAPTURE(restitution);
    Robot robot = box(20, {0.3, 0.3, 0.1});
    robot.settings.stand_on_ground = false;
    robot.settings.base.position_m = {0, 0, 0.45};
    robot.settings.world.objects = {object("ball", WorldBall{0.1, 0.37, 0, restitution}, {0, 0, 0.1})};
    BulletWorld plant(robot.model, robot.settings, 1);
    double fastest = 0, highest_m = 0;
    bool fell = false;
    for (int i = 0; i < 800; ++i) {
      plant.step(ms);
      const PlantTruth& truth = plant.truth();
      fell = fell || truth.base.position_m[2] < 0.26;
      if (!fell) continue;
      fastest = std::max(fastest, truth.com_velocity_m_s[2]);
      highest_m = std::max(highest_m, truth.base.position_m[2]);
    }
    const double hit_m_s = std::sqrt(2 * g * 0.2);
    CHECK(fastest < restitution * hit_m_s + 0.2);
    CHECK(highest_m < 0.25 + 0.2 * restitution * restitution + 0.02);
  }
}

TEST_CASE("A kick gives the ball what it takes from the robot") {
  Robot robot = box(2, {0.2, 0.2, 0.2});
  robot.settings.gravity_m_s2 = {0, 0, 0};
  robot.settings.stand_on_ground = false;
  robot.settings.base.position_m = {0, 0, 1};
  robot.settings.world.objects = {object("ball", WorldBall{0.1, 0.5, 0, 0.5}, {0.3, 0.03, 1.02})};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.push(0, {4000, 0, 0}, {0, 0, 0});  // 2 m/s
  run(plant, 300);
  const PlantTruth& truth = plant.truth();
  const Vec3& ball = truth.objects[0].velocity_m_s;
  CHECK(ball[0] > 2);
  for (std::size_t i = 0; i < 3; ++i) {
    const double total = 2 * truth.com_velocity_m_s[i] + 0.5 * ball[i];
    CHECK(total == doctest::Approx(i == 0 ? 4 : 0).epsilon(1e-9));
  }
}

TEST_CASE("Boxes stack and a free box weighs on the robot's foot") {
  Robot robot = box(4, {0.4, 0.4, 0.1});
  robot.settings.world.objects = {object("crate", WorldBox{{0.2, 0.2, 0.2}, 3}, {0, 0, 0.2}),
                                  object("upper", WorldBox{{0.2, 0.2, 0.2}, 1}, {0.02, 0, 0.4})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 3000);
  const PlantTruth& truth = plant.truth();
  CHECK(truth.objects[0].pose.position_m[2] == doctest::Approx(0.2).epsilon(1e-3));
  CHECK(truth.objects[1].pose.position_m[2] == doctest::Approx(0.4).epsilon(1e-3));
  CHECK(std::abs(truth.objects[1].pose.position_m[0] - 0.02) < 1e-4);
  CHECK(truth.objects[0].force_N[2] == doctest::Approx(4 * g).epsilon(1e-3));
  CHECK(truth.objects[1].links.none());
}

TEST_CASE("Spheres and cylinders of a robot rest on a box where they touch it") {
  for (const Shape& shape : {Shape{Sphere{0.05}}, Shape{Cylinder{0.05, 0.1}}}) {
    for (const bool lying : {false, true}) {
      Robot robot = box(1, {0.1, 0.1, 0.1});
      robot.model.links[0].collisions[0].shape = shape;
      if (lying) robot.settings.base.orientation = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};
      robot.settings.world.objects = {object("step", WorldBox{{1, 1, 0.2}}, {0, 0, 0.1})};
      BulletWorld plant(robot.model, robot.settings, 1);
      run(plant, 500);
      CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.25).epsilon(1e-4));
      CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(g).epsilon(1e-3));
    }
  }
}

TEST_CASE("A world repeats bit for bit") {
  const auto end = [] {
    Robot robot = box(2, {0.2, 0.2, 0.2});
    WorldBall ball{0.1, 0.5, 0.001, 0.5};
    ball.velocity_m_s = {-2, 0.1, 0};
    robot.settings.world.objects = {object("ball", ball, {1, 0.03, 0.1}),
                                    object("crate", WorldBox{{0.2, 0.3, 0.2}, 1}, {-0.25, 0.02, 0.1}),
                                    object("stairs", WorldStairs{3, 0.05, 0.2, 1}, {-0.5, 0, 0}),
                                    object("pendulum", WorldPendulum{1.5, 0.1, 2, 0.5}, {0.05, 0.3, 0.3})};
    robot.settings.world.payloads = {{"bag", "box", {0, 0, 0.1}, 0.5, 0.2}};
    BulletWorld plant(robot.model, robot.settings, 1);
    StateHash hash;
    for (int i = 0; i < 1500; ++i) {
      plant.step(ms);
      plant.hash(hash);
    }
    return hash.value();
  };
  CHECK(end() == end());
}

}  // namespace bullet_world_test
