#include "step_geometry.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <variant>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

// Half the edges of the box around a box or a cylinder, along its own axes.
Vec3 half_size_m(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return {box->size_m[0] / 2, box->size_m[1] / 2, box->size_m[2] / 2};
  const auto& cylinder = std::get<Cylinder>(shape);
  return {cylinder.radius_m, cylinder.radius_m, cylinder.length_m / 2};
}

void reach(FootShape& foot, const Vec3& point_m) noexcept {
  foot.front_m = std::max(foot.front_m, point_m[0]);
  foot.back_m = std::max(foot.back_m, -point_m[0]);
  foot.side_m = std::max(foot.side_m, std::abs(point_m[1]));
  foot.below_m = std::max(foot.below_m, -point_m[2]);
}

}  // namespace

FootShape shape_of(const RobotModel& model, std::size_t foot) {
  const Link& link = model.links[foot];
  FootShape shape;
  for (const Geometry& part : link.collisions) {
    if (const auto* mesh = std::get_if<Mesh>(&part.shape)) {
      for (const Vec3& corner_m : mesh->corners_m) reach(shape, transform(part.pose, corner_m));
      continue;
    }
    if (const auto* ball = std::get_if<Sphere>(&part.shape)) {
      const Vec3& at_m = part.pose.position_m;
      for (const double r : {-ball->radius_m, ball->radius_m}) reach(shape, {at_m[0] + r, at_m[1] + r, at_m[2] + r});
      continue;
    }
    const Vec3 half_m = half_size_m(part.shape);
    for (const double x : {-half_m[0], half_m[0]})
      for (const double y : {-half_m[1], half_m[1]})
        for (const double z : {-half_m[2], half_m[2]}) reach(shape, transform(part.pose, {x, y, z}));
  }
  if (!(shape.front_m > 0 && shape.back_m > 0 && shape.side_m > 0 && shape.below_m > 0))
    throw std::invalid_argument(
        "the foot " + link.name +
        " has no sole: it needs collision shapes that reach before, behind and below its frame");
  return shape;
}

LoadSplit split_load(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                     const GroundPoint& wanted) noexcept {
  const double way_x_m = right.x_m - left.x_m, way_y_m = right.y_m - left.y_m;
  const double length2 = std::max(way_x_m * way_x_m + way_y_m * way_y_m, 1e-9);
  const double x_m = wanted.x_m - left.x_m - sole.middle_m(), y_m = wanted.y_m - left.y_m;
  LoadSplit bearing;
  bearing.right_share = std::clamp((x_m * way_x_m + y_m * way_y_m) / length2, 0.0, 1.0);
  const double share = bearing.right_share;
  bearing.in_sole.x_m = std::clamp(wanted.x_m - left.x_m - share * way_x_m, -sole.heel_m, sole.toe_m);
  bearing.in_sole.y_m = std::clamp(wanted.y_m - left.y_m - share * way_y_m, -sole.half_width_m, sole.half_width_m);
  bearing.at = {left.x_m + share * way_x_m + bearing.in_sole.x_m, left.y_m + share * way_y_m + bearing.in_sole.y_m};
  return bearing;
}

double swing_way(double share) noexcept {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

double swing_lift(double share) noexcept {
  constexpr double up = 0.4, down = 0.5;
  return share < down ? swing_way(share / up) : swing_way((1 - share) / (1 - down));
}

}  // namespace kadans
