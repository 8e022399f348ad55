#include "kadans/plant/world_settings.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

constexpr double slab_m = 0.1;  // thickness of a ramp

Pose placed(const Pose& pose, const Vec3& offset_m, const Quat& turn = {1, 0, 0, 0}) {
  return {transform(pose, offset_m), multiply(pose.orientation, turn)};
}

struct SolidMaker {
  const Pose& pose;

  std::vector<SolidBox> operator()(const WorldBox& box) const { return {{pose, box.size_m}}; }
  std::vector<SolidBox> operator()(const WorldRamp& ramp) const {
    const Pose surface = placed(pose, {0, 0, 0}, from_axis_angle({0, 1, 0}, -ramp.incline_rad));
    return {{placed(surface, {ramp.length_m / 2, 0, -slab_m / 2}), {ramp.length_m, ramp.width_m, slab_m}}};
  }
  std::vector<SolidBox> operator()(const WorldStairs& stairs) const {
    std::vector<SolidBox> boxes;
    for (std::uint32_t i = 0; i < stairs.count; ++i) {
      const double height_m = (i + 1) * stairs.rise_m;
      boxes.push_back(
          {placed(pose, {(i + 0.5) * stairs.run_m, 0, height_m / 2}), {stairs.run_m, stairs.width_m, height_m}});
    }
    return boxes;
  }
  std::vector<SolidBox> operator()(const WorldWall& wall) const {
    return {{placed(pose, {0, 0, wall.height_m / 2}), {wall.thickness_m, wall.width_m, wall.height_m}}};
  }
  std::vector<SolidBox> operator()(const WorldBall&) const { return {}; }
  std::vector<SolidBox> operator()(const WorldPendulum&) const { return {}; }
};

// Where the vertical through x, y leaves the box at the top.
std::optional<double> top_m(const SolidBox& box, double x_m, double y_m) {
  const Vec3& at = box.pose.position_m;
  const Vec3 from = rotate_inverse(box.pose.orientation, {x_m - at[0], y_m - at[1], 0});
  const Vec3 up = rotate_inverse(box.pose.orientation, {0, 0, 1});
  double low_m = -std::numeric_limits<double>::infinity(), high_m = -low_m;
  for (std::size_t i = 0; i < 3; ++i) {
    const double half = box.size_m[i] / 2;
    if (std::abs(up[i]) < 1e-12) {
      if (std::abs(from[i]) > half) return std::nullopt;
      continue;
    }
    const double a = (-half - from[i]) / up[i], b = (half - from[i]) / up[i];
    low_m = std::max(low_m, std::min(a, b));
    high_m = std::min(high_m, std::max(a, b));
  }
  if (!(low_m <= high_m)) return std::nullopt;
  return at[2] + high_m;
}

}  // namespace

Vec3 velocity_at(const MotionSettings& motion, double time_s) noexcept {
  const auto& knots = motion.knots;
  if (knots.empty()) return {};
  const double last_s = knots.back().time_s;
  if (motion.repeat && last_s > 0) time_s = std::fmod(time_s, last_s);
  if (time_s <= knots.front().time_s) return knots.front().velocity_m_s;
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const auto &from = knots[i - 1], &to = knots[i];
    if (time_s >= to.time_s) continue;
    const double share = (time_s - from.time_s) / (to.time_s - from.time_s);
    Vec3 velocity{};
    for (std::size_t k = 0; k < 3; ++k)
      velocity[k] = from.velocity_m_s[k] + share * (to.velocity_m_s[k] - from.velocity_m_s[k]);
    return velocity;
  }
  return knots.back().velocity_m_s;
}

std::vector<SolidBox> solid_boxes(const WorldObject& object) {
  return std::visit(SolidMaker{object.pose}, object.shape);
}

Pose ground_pose(const WorldSettings& world) {
  const double heading = world.slope_heading_rad;
  return {{0, 0, 0}, from_axis_angle({std::sin(heading), -std::cos(heading), 0}, world.slope_rad)};
}

double surface_height_m(const WorldSettings& world, double x_m, double y_m) {
  const double heading = world.slope_heading_rad;
  double height_m = std::tan(world.slope_rad) * (x_m * std::cos(heading) + y_m * std::sin(heading));
  for (const WorldObject& object : world.objects) {
    if (object.free()) continue;
    for (const SolidBox& box : solid_boxes(object)) {
      if (const auto top = top_m(box, x_m, y_m)) height_m = std::max(height_m, *top);
    }
  }
  return height_m;
}

}  // namespace kadans
