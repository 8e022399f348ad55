// What disturbs the robot from outside: a pendulum, a floor that moves, a load.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"
#include "kadans/testing/allocation_count.h"
#include "plant/small_robots.h"

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

MotionSettings steady(const Vec3& velocity_m_s) { return {.knots = {{0, velocity_m_s}}}; }

}  // namespace

TEST_CASE("A pendulum is held until its release and then swings with its period") {
  Robot robot = box(1, {0.1, 0.1, 0.1});
  WorldPendulum shape{.length_m = 1.5, .radius_m = 0.1, .mass_kg = 2, .distance_m = 0.1, .release_s = 0.5};
  robot.settings.world.objects = {object("pendulum", shape, {3, 0, 1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 500);
  const ObjectTruth& bob = plant.truth().objects[0];
  CHECK(bob.pose.position_m[0] == doctest::Approx(2.9).epsilon(1e-9));
  CHECK(bob.velocity_m_s[0] == 0);
  const double swing_rad = std::asin(0.1 / 1.5), about_hinge = 1.5 * 1.5 + 0.4 * 0.1 * 0.1;
  const double period_s = 2 * M_PI * std::sqrt(about_hinge / (g * 1.5)) * (1 + swing_rad * swing_rad / 16);
  int crossings = 0;
  double first_s = 0, last_s = 0, before_m = -0.1;
  for (int i = 0; i < 12000; ++i) {
    plant.step(ms);
    const double at_m = bob.pose.position_m[0] - 3;
    if (before_m < 0 && at_m >= 0) {
      last_s = (i + before_m / (before_m - at_m)) * 1e-3;
      if (crossings++ == 0) first_s = last_s;
    }
    before_m = at_m;
  }
  REQUIRE(crossings > 3);
  CHECK((last_s - first_s) / (crossings - 1) == doctest::Approx(period_s).epsilon(2e-3));
}

TEST_CASE("A pendulum hits with the speed of its fall and loses what the robot gains") {
  Robot robot = box(4, {0.2, 0.2, 0.2});
  robot.settings.ground_friction = 0;
  WorldPendulum shape{.length_m = 1.5, .radius_m = 0.05, .mass_kg = 2, .distance_m = 0.4};
  robot.settings.world.objects = {object("pendulum", shape, {-0.15, 0, 0.1})};  // touches the box when it hangs
  BulletWorld plant(robot.model, robot.settings, 1);
  double fastest = 0;
  for (int i = 0; i < 650; ++i) {
    plant.step(ms);
    fastest = std::max(fastest, plant.truth().objects[0].velocity_m_s[0]);
  }
  const double fall_m = 1.5 - std::sqrt(1.5 * 1.5 - 0.4 * 0.4);
  CHECK(fastest == doctest::Approx(std::sqrt(2 * g * fall_m)).epsilon(0.01));
  // Both go on at one speed: the rod's share of the bob's inertia is none.
  CHECK(plant.truth().com_velocity_m_s[0] == doctest::Approx(2 * fastest / 6).epsilon(0.03));
}

TEST_CASE("A floor that moves carries what stands on it") {
  for (const bool ground : {false, true}) {
    Robot robot = box(4, {0.22, 0.1, 0.03});
    robot.settings.surfaces.push_back({"box", 0.8});
    const MotionSettings motion{.knots = {{0, {0, 0, 0}}, {0.5, {0.4, -0.2, 0}}}};
    if (ground) {
      robot.settings.world.ground_motion = motion;
    } else {
      robot.settings.world.objects = {object("platform", WorldBox{{2, 2, 0.1}}, {0, 0, 0.05})};
      robot.settings.world.objects[0].motion = motion;
    }
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 1500);
    const PlantTruth& truth = plant.truth();
    CHECK(truth.base_velocity_m_s[0] == doctest::Approx(0.4).epsilon(1e-3));
    CHECK(truth.base_velocity_m_s[1] == doctest::Approx(-0.2).epsilon(1e-3));
    CHECK(truth.base.position_m[0] == doctest::Approx(0.4 * 1.25).epsilon(2e-3));
    if (!ground) CHECK(truth.objects[0].pose.position_m[0] == doctest::Approx(0.4 * 1.25).epsilon(2e-3));
    CHECK(truth.foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-3));
  }
}

TEST_CASE("A conveyor carries and stays, a slippery patch carries little") {
  for (const double friction : {1.0, 0.01}) {
    Robot robot = box(4, {0.22, 0.1, 0.03});
    robot.settings.surfaces.push_back({"box", 0.8});
    robot.settings.world.objects = {object("belt", WorldBox{{2, 2, 0.1}}, {0, 0, 0.05})};
    robot.settings.world.objects[0].friction = friction;
    robot.settings.world.objects[0].motion = steady({0.3, 0, 0});
    robot.settings.world.objects[0].motion.conveyor = true;
    BulletWorld plant(robot.model, robot.settings, 1);
    run(plant, 1000);
    const double expected = friction == 1 ? 0.3 : 0.8 * friction * g * 1;
    CHECK(plant.truth().base_velocity_m_s[0] == doctest::Approx(expected).epsilon(0.01));
    CHECK(plant.truth().objects[0].pose.position_m[0] == 0);
  }
}

TEST_CASE("A lift presses with the weight and its acceleration") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.world.objects = {object("lift", WorldBox{{1, 1, 0.1}}, {0, 0, 0.05})};
  robot.settings.world.objects[0].motion = {.knots = {{0, {0, 0, 0}}, {1, {0, 0, 2}}}};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 500);
  CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(4 * (g + 2)).epsilon(1e-3));
}

TEST_CASE("A profile repeats after its last knot") {
  const MotionSettings shake{.knots = {{0, {0, 0, 0}}, {1, {2, 0, 0}}, {2, {0, 0, 0}}}, .repeat = true};
  CHECK(velocity_at(shake, 0.5)[0] == doctest::Approx(1));
  CHECK(velocity_at(shake, 3.5)[0] == doctest::Approx(1));
  CHECK(velocity_at({.knots = shake.knots}, 3.5)[0] == 0);
}

TEST_CASE("A payload weighs on the feet from its time on, until its end") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.world.payloads = {
      {.name = "bag", .link = "box", .point_m = {0.05, 0, 0.1}, .mass_kg = 1.5, .from_s = 0.5, .until_s = 1}};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 490);
  CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-4));
  run(plant, 490);
  CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(5.5 * g).epsilon(1e-4));
  CHECK(plant.truth().com_m[0] == doctest::Approx(1.5 * 0.05 / 5.5).epsilon(1e-4));
  SensorFrame sensors;
  plant.read(sensors);
  const auto& force_N = sensors.feet[0].force_N;
  CHECK(0.11 * (force_N[2] + force_N[3] - force_N[0] - force_N[1]) == doctest::Approx(1.5 * g * 0.05).epsilon(1e-2));
  run(plant, 500);
  CHECK(plant.truth().foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-4));
}

TEST_CASE("A payload's inertia is in what a torque turns") {
  Robot robot = pendulum(1, 0.1, 0.02);
  robot.drive().torque_max_Nm = 1;
  robot.settings.world.payloads = {{.name = "weight", .link = "arm", .point_m = {0, 0, -0.3}, .mass_kg = 0.5}};
  BulletWorld plant(robot.model, robot.settings, 1);
  plant.write(effort(0.1));
  run(plant, 500);
  CHECK(plant.truth().velocity_rad_s[0] == doctest::Approx(0.1 * 0.5 / (0.02 + 0.5 * 0.09)).epsilon(1e-3));
}

TEST_CASE("A ball that is put elsewhere lies there at rest, and a fixed object cannot be put") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  WorldObject ball{.name = "ball", .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4, .velocity_m_s = {2, 0, 0}}};
  ball.pose.position_m = {1, 0, 0.1};
  WorldObject wall{.name = "wall", .shape = WorldWall{1, 1, 0.1}};
  wall.pose.position_m = {5, 0, 0};
  robot.settings.world.objects = {ball, wall};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 200);
  CHECK(plant.truth().objects[0].pose.position_m[0] > 1.3);
  plant.put(0, {-2, 3, 0.1});
  run(plant, 200);
  const ObjectTruth& there = plant.truth().objects[0];
  CHECK(std::abs(there.pose.position_m[0] + 2) < 1e-4);
  CHECK(std::abs(there.pose.position_m[1] - 3) < 1e-4);
  CHECK(std::abs(there.velocity_m_s[0]) < 1e-6);
  CHECK_THROWS_WITH(plant.put(1, {0, 0, 0}), "put: 'wall' is not free");
  CHECK_THROWS_WITH(plant.put(2, {0, 0, 0}), "put: no object number 2");
  CHECK_THROWS_WITH(plant.put(0, {0, NAN, 0}), "put: the place must be finite");
}

TEST_CASE("A robot that is carried stands where it is put, turned, with the weight that it had") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.surfaces.push_back({"box", 0.8});
  WorldObject step{.name = "step", .shape = WorldBox{{1, 1, 0.2}}};
  step.pose.position_m = {3, 0, 0.1};
  robot.settings.world.objects = {step};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 100);
  plant.push(0, {50, 0, 0}, {0, 0, 0});
  run(plant, 5);
  plant.carry(3, 0.2, 1.5);
  run(plant, 500);
  const PlantTruth& truth = plant.truth();
  CHECK(std::abs(truth.base.position_m[0] - 3) < 1e-4);
  CHECK(std::abs(truth.base.position_m[1] - 0.2) < 1e-4);
  CHECK(std::abs(truth.base.position_m[2] - 0.215) < 1e-5);  // on the step
  CHECK(std::abs(roll_pitch_yaw(truth.base.orientation)[2] - 1.5) < 1e-4);
  CHECK(truth.foot_force_N[0][2] == doctest::Approx(4 * g).epsilon(1e-3));
  CHECK_THROWS_WITH(plant.carry(0, INFINITY, 0), "carry: the place must be finite");
  robot.settings.fixed_base = true;
  BulletWorld bolted(robot.model, robot.settings, 1);
  CHECK_THROWS_WITH(bolted.carry(0, 0, 0), "carry: the base is fixed");
}

TEST_CASE("A ball that is put into a robot, or a robot onto a ball, comes to lie beside it") {
  Robot robot = box(4, {0.4, 0.2, 0.2});
  robot.settings.world.objects = {object("ball", WorldBall{.radius_m = 0.1, .mass_kg = 0.4}, {2, 0, 0.1})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 100);
  plant.put(0, {0.05, 0.05, 0.1});
  run(plant, 300);
  const PlantTruth& truth = plant.truth();
  CHECK(std::abs(truth.objects[0].pose.position_m[0] - 0.05) < 1e-3);
  CHECK(std::abs(truth.objects[0].pose.position_m[1] - 0.25) < 1e-3);
  CHECK(std::hypot(truth.base.position_m[0], truth.base.position_m[1]) < 1e-3);
  plant.put(0, {2, 0, 0.1});
  plant.carry(2, 0, 1.5707963);
  run(plant, 300);
  CHECK(std::abs(truth.base.position_m[0] - 1.8) < 1e-3);  // its left is where x falls
  CHECK(std::abs(truth.base.position_m[1]) < 1e-3);
  CHECK(std::abs(truth.objects[0].pose.position_m[0] - 2) < 1e-3);
}

TEST_CASE("Nothing is put into what is fixed, or into the ground") {
  Robot robot = box(4, {0.4, 0.2, 0.2});
  robot.settings.world.objects = {object("ball", WorldBall{.radius_m = 0.1, .mass_kg = 0.4}, {2, 0, 0.1}),
                                  object("wall", WorldBox{{0.1, 0.1, 1}}, {4, 0, 0.5})};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 100);
  plant.put(0, {4, 0, 0.1});
  plant.carry(4, 0, 0);  // its corners stand around the wall, which is in its middle
  run(plant, 300);
  const PlantTruth& truth = plant.truth();
  CHECK(std::abs(truth.objects[0].pose.position_m[2] - 0.1) < 1e-3);
  CHECK(std::hypot(truth.objects[0].pose.position_m[0] - 4, truth.objects[0].pose.position_m[1]) > 0.14);
  CHECK(std::abs(truth.base.position_m[2] - 0.1) < 1e-3);
  CHECK(std::abs(truth.base.position_m[1]) > 0.14);
  CHECK_THROWS_WITH(plant.put(0, {0, 3, -1}), "put: 'ball' would lie 1100 mm deep in the ground");
}

TEST_CASE("A world that has settled allocates nothing more") {
  Robot robot = box(4, {0.22, 0.1, 0.03});
  robot.settings.world.objects = {object("step", WorldBox{{1, 1, 0.2}}, {0, 0, 0.1}),
                                  object("ball", WorldBall{0.07, 0.4, 0.002, 0.6}, {0.3, 0.2, 0.27}),
                                  object("pendulum", WorldPendulum{1.5, 0.1, 2, 0.5}, {3, 0.3, 0.3})};
  robot.settings.world.ground_motion = steady({0.1, 0, 0});
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 1000);
  const testing::AllocationCount heap;
  run(plant, 1000);
  const long allocations = heap.count();
  CHECK(allocations == 0);
}
