// Hulls of meshes touch the ground, boxes and each other.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "plant/small_robots.h"

namespace kadans::test {
namespace {

Mesh box_hull(const Vec3& size_m) {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.corners_m.push_back({((i & 1) != 0 ? 0.5 : -0.5) * size_m[0], ((i & 2) != 0 ? 0.5 : -0.5) * size_m[1],
                              ((i & 4) != 0 ? 0.5 : -0.5) * size_m[2]});
  return mesh;
}

// A disc of 16 corners below and above.
Mesh disc_hull(double radius_m, double height_m) {
  Mesh mesh;
  for (int i = 0; i < 32; ++i) {
    const double angle = (i / 2) * std::numbers::pi / 8;
    mesh.corners_m.push_back(
        {radius_m * std::cos(angle), radius_m * std::sin(angle), (i % 2 != 0 ? 0.5 : -0.5) * height_m});
  }
  return mesh;
}

Robot as_hull(Robot robot, const Mesh& mesh) {
  robot.model.links[0].collisions[0].shape = mesh;
  return robot;
}

}  // namespace

TEST_CASE("A hull with the corners of a box rests, slides and bears as the box does") {
  for (const double slope_rad : {0.0, 0.3, 0.6}) {
    CAPTURE(slope_rad);
    Robot robot = box(2, {0.2, 0.3, 0.1});
    robot.settings.gravity_m_s2 = {g * std::sin(slope_rad), 0, -g * std::cos(slope_rad)};
    robot.settings.ground_friction = 0.5;
    const Robot hull = as_hull(robot, box_hull({0.2, 0.3, 0.1}));
    BulletWorld one(robot.model, robot.settings, 1), other(hull.model, hull.settings, 1);
    run(one, 500);
    run(other, 500);
    for (std::size_t i = 0; i < 3; ++i) {
      CHECK(other.truth().base.position_m[i] == doctest::Approx(one.truth().base.position_m[i]).epsilon(1e-6));
      CHECK(other.truth().foot_force_N[0][i] == doctest::Approx(one.truth().foot_force_N[0][i]).epsilon(1e-6));
    }
  }
}

TEST_CASE("A hull stands on many corners without creeping or tilting") {
  const Robot robot = as_hull(box(3, {0.2, 0.2, 0.05}), disc_hull(0.1, 0.05));
  BulletWorld plant(robot.model, robot.settings, 1);
  CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.025).epsilon(1e-9));
  for (int i = 0; i < 3000; ++i) {
    plant.push(0, {3 * std::sin(0.01 * i), 2 * std::cos(0.013 * i), 0}, {0, 0, 0.02});
    plant.step(ms);
  }
  CHECK(std::hypot(plant.truth().base.position_m[0], plant.truth().base.position_m[1]) < 1e-4);
  CHECK(std::abs(plant.truth().base.position_m[2] - 0.025) < 1e-5);
  CHECK(std::abs(plant.truth().base.orientation[0]) == doctest::Approx(1).epsilon(1e-6));
}

TEST_CASE("A hull whose middle is far from its frame touches the ground where its corners are") {
  Robot robot = box(1, {0.1, 0.1, 0.1});
  Mesh mesh = box_hull({0.1, 0.1, 0.1});
  for (Vec3& corner : mesh.corners_m) corner[2] -= 1;
  robot = as_hull(robot, mesh);
  robot.model.links[0].inertia.com_m = {0, 0, -1};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 500);
  CHECK(plant.truth().base.position_m[2] == doctest::Approx(1.05).epsilon(1e-5));
}

TEST_CASE("A hull stands on a box of the world as on the ground, and a ball stays on a hull") {
  Robot robot = as_hull(box(2, {0.3, 0.3, 0.1}), box_hull({0.3, 0.3, 0.1}));
  robot.settings.world.objects = {
      {.name = "table", .shape = WorldBox{{1, 1, 0.4}}, .pose = {{0, 0, 0.2}, {1, 0, 0, 0}}},
      {.name = "ball", .shape = WorldBall{.radius_m = 0.05, .mass_kg = 0.2}, .pose = {{0, 0, 0.56}, {1, 0, 0, 0}}}};
  BulletWorld plant(robot.model, robot.settings, 1);
  run(plant, 1000);
  CHECK(plant.truth().base.position_m[2] == doctest::Approx(0.45).epsilon(1e-4));
  CHECK(std::abs(plant.truth().base.orientation[0]) == doctest::Approx(1).epsilon(1e-6));
  CHECK(plant.truth().objects[1].pose.position_m[2] == doctest::Approx(0.55).epsilon(5e-3));
}

TEST_CASE("A hull that swings in stops at the hull of another link") {
  for (const bool hulls : {false, true}) {
    CAPTURE(hulls);
    const auto part = [&](const Vec3& size_m) -> Shape { return hulls ? Shape(box_hull(size_m)) : Shape(Box{size_m}); };
    Robot robot = pendulum(0.5, 0.18, 0.02);
    robot.model.links[0].collisions.push_back({"torso", "base", {{0, 0, -0.2}, {1, 0, 0, 0}}, part({0.16, 0.24, 0.4})});
    robot.model.links[1].collisions.push_back({"arm", "arm", {{0, 0, -0.18}, {1, 0, 0, 0}}, part({0.04, 0.04, 0.36})});
    Link shoulder;
    shoulder.name = "shoulder";
    shoulder.inertia = {.mass_kg = 0.1, .xx = 1e-3, .yy = 1e-3, .zz = 1e-3};
    robot.model.links.insert(robot.model.links.begin() + 1, shoulder);
    robot.model.joints[0].origin.position_m = {0, 0.17, 0};
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
    robot.settings.self_collision = true;
    BulletWorld plant(robot.model, robot.settings, 1);
    plant.write(both({}, {.effort_Nm = -0.5, .mode = ActuationMode::effort}));
    double furthest_rad = 0;
    for (int i = 0; i < 600; ++i) {
      plant.step(ms);
      furthest_rad = std::min(furthest_rad, plant.truth().position_rad[0] + plant.truth().position_rad[1]);
    }
    CHECK(furthest_rad < -0.02);
    CHECK(furthest_rad > -0.15);  // 3 cm at the hand
  }
}

TEST_CASE(
    "A mesh that nobody has read is refused by the plant, with what is missing, and so is one of too many corners") {
  const auto refusal = [](const Mesh& mesh) -> std::string {
    const Robot robot = as_hull(box(2, {0.1, 0.1, 0.1}), mesh);
    try {
      const BulletWorld plant(robot.model, robot.settings, 1);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "none";
  };
  CHECK(refusal({.file = "foot.stl"}) ==
        "collision mesh 'foot.stl' of link 'box' was not read: the program kadans-hull, which reads meshes, is not "
        "installed");
  Mesh many{.file = "foot.stl"};
  many.corners_m.resize(65);
  CHECK(refusal(many) == "collision mesh 'foot.stl' of link 'box' has a hull of 65 corners; at most 64");
}

}  // namespace kadans::test
