#include "control/walk/step_geometry.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include "kadans/model/kinematics.h"

using namespace kadans;

namespace {

constexpr Sole sole{.heel_m = 0.06, .toe_m = 0.12, .half_width_m = 0.03};
constexpr GroundPoint left{0.1, 0.1}, right{-0.1, -0.1};  // the left one ahead

RobotModel foot_of(const std::vector<Geometry>& collisions) {
  RobotModel model;
  model.links.push_back({.name = "foot", .collisions = collisions});
  return model;
}

}  // namespace

TEST_CASE("a foot reaches as far as what collides of it, in any shape and turned") {
  const Pose beside{{0.03, 0.01, -0.05}, from_axis_angle({0, 0, 1}, std::numbers::pi / 2)};
  const FootShape box = shape_of(foot_of({{.pose = beside, .shape = Box{{0.1, 0.2, 0.02}}}}), 0);
  CHECK(box.front_m == doctest::Approx(0.13));
  CHECK(box.back_m == doctest::Approx(0.07));
  CHECK(box.side_m == doctest::Approx(0.06));
  CHECK(box.below_m == doctest::Approx(0.06));
  const FootShape two =
      shape_of(foot_of({{.pose = {{0.1, 0, -0.03}, from_axis_angle({0, 1, 0}, 0.8)}, .shape = Sphere{0.02}},
                        {.pose = {{-0.06, 0, -0.03}}, .shape = Cylinder{0.02, 0.04}}}),
               0);
  CHECK(two.front_m == doctest::Approx(0.12));
  CHECK(two.back_m == doctest::Approx(0.08));
  CHECK(two.below_m == doctest::Approx(0.05));
  const FootShape mesh = shape_of(
      foot_of({{.shape = Mesh{.corners_m = {{0.1, 0.03, -0.04}, {-0.05, 0, -0.04}, {0, -0.04, 0}, {0, 0, 0.1}}}}}), 0);
  CHECK(mesh.front_m == doctest::Approx(0.1));
  CHECK(mesh.side_m == doctest::Approx(0.04));
  CHECK(mesh.below_m == doctest::Approx(0.04));
  CHECK_THROWS_WITH_AS(shape_of(foot_of({}), 0), doctest::Contains("the foot foot has no sole"), std::invalid_argument);
}

TEST_CASE("a load over the middle of one sole is borne by that foot alone") {
  const LoadSplit split = split_load(sole, left, right, {-0.1 + sole.middle_m(), -0.1});
  CHECK(split.right_share == doctest::Approx(1));
  CHECK(split.in_sole.x_m == doctest::Approx(sole.middle_m()));
  CHECK(split.at.x_m == doctest::Approx(-0.1 + sole.middle_m()));
}

TEST_CASE("a load between the soles is shared, and both are pressed at the same place") {
  const LoadSplit split = split_load(sole, left, right, {sole.middle_m(), 0});
  CHECK(split.right_share == doctest::Approx(0.5));
  CHECK(split.at.x_m == doctest::Approx(sole.middle_m()));
  CHECK(split.at.y_m == doctest::Approx(0));
}

TEST_CASE("what lies beyond the soles is brought to their edge") {
  const LoadSplit split = split_load(sole, left, right, {0.4, 0.1});
  CHECK(split.right_share == 0);
  CHECK(split.at.x_m == doctest::Approx(0.1 + sole.toe_m));
}

TEST_CASE("a swing begins and ends at rest on the ground") {
  for (const double end : {0.0, 1.0}) {
    CHECK(swing_way(end) == doctest::Approx(end));
    CHECK(swing_lift(end) == doctest::Approx(0));
    CHECK(std::abs(swing_way(end + 1e-4) - swing_way(end - 1e-4)) < 1e-6);
    CHECK(std::abs(swing_lift(end + 1e-4) - swing_lift(end - 1e-4)) < 1e-6);
  }
  CHECK(swing_lift(0.45) == doctest::Approx(1));
  for (double share = 0; share < 1; share += 0.05) CHECK(swing_way(share + 0.05) > swing_way(share));
}
