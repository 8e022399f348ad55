// Several robots in one world.
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "plant/tulip_robot.h"

using namespace kadans;
using namespace kadans::test;

namespace {

Robot at(Robot robot, const Vec3& position_m) {
  robot.settings.base.position_m = position_m;
  return robot;
}

Robot box_at(double mass_kg, const Vec3& position_m, double gravity_m_s2 = g) {
  Robot robot = at(box(mass_kg, {0.2, 0.2, 0.2}), position_m);
  robot.settings.stand_on_ground = false;
  robot.settings.gravity_m_s2 = {0, 0, -gravity_m_s2};
  return robot;
}

std::array<WorldSite, 2> sites(const Robot& first, const Robot& second) {
  return {{{first.model, first.settings, 1}, {second.model, second.settings, 2}}};
}

double kinetic_J(const PlantTruth& truth, double mass_kg) {  // of a box of box_at
  const Vec3 &v = truth.com_velocity_m_s, &w = truth.base_angular_velocity_rad_s;
  const double moment = mass_kg * 0.04 / 6;
  return (mass_kg * (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) + moment * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2])) / 2;
}

bool same(const PlantTruth& a, const PlantTruth& b) {
  return a.base.position_m == b.base.position_m && a.base.orientation == b.base.orientation &&
         a.position_rad == b.position_rad && a.velocity_rad_s == b.velocity_rad_s && a.foot_force_N == b.foot_force_N &&
         a.touching_links == b.touching_links;
}

// Two TULips that hold their joints; the second is 0.9 m to the left of the first, or further.
class Pair {
 public:
  explicit Pair(double apart_m = 0.9) : second_(at(tulip(Drives::rigid), {0, apart_m, 0})) {}

  void tick() {
    for (std::size_t i = 0; i < 2; ++i) holds_[i].act(world.robot(i));
    world.step(ms);
  }
  const PlantTruth& truth(std::size_t robot) { return world.robot(robot).truth(); }

 private:
  Robot first_ = tulip(Drives::rigid), second_;
  std::array<JointHold, 2> holds_{JointHold(first_), JointHold(second_)};

 public:
  BulletWorld world{sites(first_, second_)};
};

}  // namespace

TEST_CASE("A robot that is carried into another one is put down beside it, and none is thrown") {
  Pair pair;
  for (int i = 0; i < 100; ++i) pair.tick();
  const double y_m = pair.truth(0).base.position_m[1];
  pair.world.robot(1).carry(0.02, y_m + 0.03, 0);
  double fastest_rad_s = 0;
  for (int i = 0; i < 200; ++i) {
    pair.tick();
    for (std::size_t robot = 0; robot < 2; ++robot) {
      const auto& velocity = pair.truth(robot).velocity_rad_s;
      for (const double joint : velocity) fastest_rad_s = std::max(fastest_rad_s, std::abs(joint));
    }
  }
  CHECK(fastest_rad_s < 1);
  const double apart_m = pair.truth(1).base.position_m[1] - pair.truth(0).base.position_m[1];
  CHECK(apart_m > 0.2);
  CHECK(apart_m < 0.7);
  CHECK(std::abs(pair.truth(1).base.position_m[0] - 0.02) < 0.02);
}

TEST_CASE("Robots that start deep in each other or in an object are refused, with links and depth") {
  const Robot first = box_at(4, {0, 0, 0.1}), second = box_at(4, {0.15, 0, 0.1});
  CHECK_THROWS_WITH_AS(BulletWorld(sites(first, second)),
                       "start: link 'box' of robot 1 is 50 mm deep in link 'box' of robot 2; start elsewhere "
                       "(start.x_m, start.y_m)",
                       std::invalid_argument);
  CHECK_NOTHROW(BulletWorld(sites(first, box_at(4, {0.197, 0, 0.1}))));
  Robot before = box_at(4, {0, 0, 0.1});
  WorldObject wall{.name = "wall", .shape = WorldBox{{0.1, 1, 1}}};
  wall.pose.position_m = {0.12, 0, 0.5};
  before.settings.world.objects = {wall};
  CHECK_THROWS_WITH_AS(BulletWorld(before.model, before.settings, 1),
                       "start: link 'box' is 30 mm deep in the world's 'wall'; start elsewhere (start.x_m, start.y_m)",
                       std::invalid_argument);
}

TEST_CASE("A robot moves bit for bit as without another one that it does not touch, first or second, also in a fall") {
  const Robot robot = tulip(Drives::rigid);
  const Robot far = at(tulip(Drives::rigid), {0.1, 5, 0});
  for (const std::size_t number : {std::size_t{0}, std::size_t{1}}) {
    CAPTURE(number);
    std::array<WorldSite, 2> both{{{far.model, far.settings, 2}, {far.model, far.settings, 2}}};
    const std::array<WorldSite, 2> order[2] = {{{{robot.model, robot.settings, 1}, both[0]}},
                                               {{both[0], {robot.model, robot.settings, 1}}}};
    BulletWorld alone(robot.model, robot.settings, 1), world(order[number]);
    JointHold hold(robot), hold_alone(robot), hold_far(far);
    int different = 0;
    for (int i = 0; i < 3000; ++i) {
      hold_alone.act(alone);
      hold.act(world.robot(number));
      hold_far.act(world.robot(1 - number));
      if (i >= 500 && i < 900) {
        alone.push(0, {60, 25, 0}, {});
        world.robot(number).push(0, {60, 25, 0}, {});
      }
      if (i >= 300 && i < 700) world.robot(1 - number).push(0, {-70, 0, 0}, {});
      alone.step(ms);
      world.step(ms);
      if (!same(alone.truth(), world.robot(number).truth())) ++different;
    }
    CHECK(different == 0);
    CHECK(alone.truth().base.position_m[2] < 0.5);
  }
}

TEST_CASE("Two boxes that collide keep their momentum, and lose energy but gain none") {
  const Robot left = box_at(1, {0, 0, 1}, 0), right = box_at(3, {0.31, 0.05, 1.04}, 0);
  BulletWorld world(sites(left, right));
  world.robot(0).push(0, {2000, 0, 0}, {});
  world.step(ms);
  REQUIRE(world.robot(0).truth().com_velocity_m_s[0] == doctest::Approx(2));
  double last_J = kinetic_J(world.robot(0).truth(), 1), gained_J = 0;
  LinkSet touched;
  Vec3 impulse_Ns{};
  for (int i = 0; i < 500; ++i) {
    world.step(ms);
    const PlantTruth &a = world.robot(0).truth(), &b = world.robot(1).truth();
    touched |= a.robot_links;
    for (std::size_t k = 0; k < 3; ++k) {
      CHECK(a.com_velocity_m_s[k] + 3 * b.com_velocity_m_s[k] == doctest::Approx(k == 0 ? 2 : 0).epsilon(1e-9));
      CHECK(a.robots_force_N[k] == doctest::Approx(-b.robots_force_N[k]));
      impulse_Ns[k] += b.robots_force_N[k] * 1e-3;
    }
    const double now_J = kinetic_J(a, 1) + kinetic_J(b, 3);
    gained_J = std::max(gained_J, now_J - last_J);
    last_J = now_J;
  }
  CHECK(touched.test(0));
  CHECK(impulse_Ns[0] == doctest::Approx(3 * world.robot(1).truth().com_velocity_m_s[0]).epsilon(1e-6));
  CHECK(world.robot(1).truth().com_velocity_m_s[0] > 0.4);
  CHECK(gained_J < 1e-9);
}

TEST_CASE("A robot that stands on another presses on it with its weight") {
  const Robot under = box_at(3, {0, 0, 0.1}), over = box_at(2, {0.02, 0, 0.3});
  BulletWorld world(sites(under, over));
  run(world, 1000);
  const PlantTruth &below = world.robot(0).truth(), &above = world.robot(1).truth();
  CHECK(below.foot_force_N[0][2] == doctest::Approx(3 * g).epsilon(1e-3));  // from the ground, less the load on top
  CHECK(above.foot_force_N[0][2] == doctest::Approx(2 * g).epsilon(1e-3));
  CHECK(above.robots_force_N[2] == doctest::Approx(2 * g).epsilon(1e-3));
  CHECK(below.robots_force_N[2] == doctest::Approx(-2 * g).epsilon(1e-3));
  CHECK(above.robot_links.test(0));
  CHECK_FALSE(above.ground_links.any());
  CHECK(below.ground_links.test(0));
  CHECK(std::abs(above.base.position_m[2] - 0.3) < 1e-4);
}

TEST_CASE("A tower of three robots stands, whatever their order") {
  const Robot low = box_at(3, {0, 0, 0.1}), top = box_at(1, {0.01, 0, 0.5}), middle = box_at(2, {0, 0.01, 0.3});
  const std::array<WorldSite, 3> tower{
      {{low.model, low.settings, 1}, {top.model, top.settings, 2}, {middle.model, middle.settings, 3}}};
  BulletWorld world(tower);
  run(world, 1000);
  CHECK(world.robot(0).truth().robots_force_N[2] == doctest::Approx(-3 * g).epsilon(1e-3));
  CHECK(world.robot(1).truth().robots_force_N[2] == doctest::Approx(1 * g).epsilon(1e-3));
  CHECK(world.robot(2).truth().robots_force_N[2] == doctest::Approx(2 * g).epsilon(1e-3));
  CHECK(std::abs(world.robot(1).truth().base.position_m[2] - 0.5) < 1e-4);
}

TEST_CASE("Either robot kicks the ball of the world, and only the one that kicks is told so") {
  for (const std::size_t kicks : {std::size_t{0}, std::size_t{1}}) {
    CAPTURE(kicks);
    Robot first = box_at(2, {0, 0, 0.1}), second = box_at(2, {2, 0, 0.1});
    const double ball_x_m = kicks == 0 ? 0.25 : 2.25;
    first.settings.world.objects = {{.name = "ball",
                                     .shape = WorldBall{.radius_m = 0.1, .mass_kg = 0.4},
                                     .pose = {.position_m = {ball_x_m, 0, 0.1}}}};
    BulletWorld world(sites(first, second));
    Vec3 impulse_Ns{};
    for (int i = 0; i < 200; ++i) {
      if (i < 20) world.robot(kicks).push(0, {300, 0, 0}, {});
      world.step(ms);
      const ObjectTruth& ball = world.robot(kicks).truth().objects[0];
      for (std::size_t k = 0; k < 3; ++k) impulse_Ns[k] += ball.force_N[k] * 1e-3;
      CHECK_FALSE(world.robot(1 - kicks).truth().objects[0].links.any());
    }
    const ObjectTruth &told = world.robot(kicks).truth().objects[0], &other = world.robot(1 - kicks).truth().objects[0];
    CHECK(told.velocity_m_s[0] > 0.5);
    CHECK(impulse_Ns[0] > 0.4 * told.velocity_m_s[0]);  // the ground takes a part
    CHECK(told.pose.position_m == other.pose.position_m);
  }
}

TEST_CASE("Robots that stand on one moving box of the world are both carried") {
  Robot first = box_at(2, {-0.3, 0, 0.3}), second = box_at(3, {0.3, 0, 0.3});
  first.settings.world.objects = {
      {.name = "step", .shape = WorldBox{{2, 2, 0.2}}, .pose = {.position_m = {0, 0, 0.1}}}};
  first.settings.world.objects[0].motion = {.knots = {{0, {0.2, 0, 0}}}};
  BulletWorld world(sites(first, second));
  run(world, 500);
  for (const std::size_t robot : {std::size_t{0}, std::size_t{1}}) {
    const PlantTruth& truth = world.robot(robot).truth();
    CHECK(truth.objects[0].links.test(0));
    CHECK(truth.objects[0].force_N[2] == doctest::Approx(-(robot == 0 ? 2 : 3) * g).epsilon(1e-3));
    CHECK(truth.base_velocity_m_s[0] == doctest::Approx(0.2).epsilon(1e-3));
    CHECK_FALSE(truth.robot_links.any());
  }
}

TEST_CASE("Two TULips stand side by side, one falls onto the other, and both feel it") {
  Pair pair(0.6);
  for (int i = 0; i < 1000; ++i) pair.tick();
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(pair.truth(i).base.position_m[2] > 0.8);
    CHECK_FALSE(pair.truth(i).robot_links.any());
  }
  const double stood_m = pair.truth(1).base.position_m[1];
  double hit_N = 0, unbalanced_N = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i < 300) pair.world.robot(0).push(0, {0, 80, 0}, {});
    pair.tick();
    for (std::size_t k = 0; k < 3; ++k) {
      const double first_N = pair.truth(0).robots_force_N[k], second_N = pair.truth(1).robots_force_N[k];
      hit_N = std::max(hit_N, std::abs(second_N));
      unbalanced_N = std::max(unbalanced_N, std::abs(first_N + second_N));
    }
    CHECK(pair.truth(0).robot_links.any() == pair.truth(1).robot_links.any());
  }
  CHECK(hit_N > 50);
  CHECK(unbalanced_N < 1e-9 * hit_N);
  CHECK(pair.truth(1).base.position_m[1] > stood_m + 0.1);
  CHECK(pair.truth(0).base.position_m[2] < 0.6);
}

TEST_CASE("Two TULips that fall onto each other allocate nothing, and do it the same way twice") {
  std::array<std::uint64_t, 2> hashes{};
  for (std::uint64_t& hash : hashes) {
    Pair pair(0.6);
    [[maybe_unused]] long allocations = 0;
    for (int i = 0; i < 3500; ++i) {
      const testing::AllocationCount heap;
      if (i >= 1000 && i < 1300) pair.world.robot(0).push(0, {0, 80, 0}, {});
      pair.tick();
      if (i >= 1000) allocations += heap.count();
    }
#ifndef KADANS_SANITIZED  // Bullet's own memory, bullet_memory.h
    CHECK(allocations == 0);
#endif
    hash = state_hash(pair.world);
  }
  CHECK(hashes[0] == hashes[1]);
}

TEST_CASE("A world of several robots needs the tree solver, and a world needs a robot") {
  Robot robot = box(1, {0.1, 0.1, 0.1});
  CHECK_THROWS_AS(BulletWorld(std::span<const WorldSite>()), std::invalid_argument);
  robot.settings.solver = ContactSolver::stock;
  CHECK_THROWS_WITH_AS(BulletWorld(sites(robot, robot)), "several robots in one world need the tree solver",
                       std::invalid_argument);
}
