#include "body_way.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans {
namespace {

using Eigen::Index;
using Wrench = Eigen::Vector<double, 6>;

constexpr int way_points = 12;
constexpr double peak_per_mean = 1.875;  // of a minimum-jerk motion's speed
constexpr double least_room_m = 0.003;   // to an edge at rest: below this no time is long enough

struct Curve {
  double way, speed, acceleration;
};
Curve minimum_jerk_at(double u) noexcept {
  return {u * u * u * (10 + u * (-15 + 6 * u)), 30 * u * u * (1 + u * (-2 + u)), 60 * u * (1 + u * (-3 + 2 * u))};
}

// The square of the time in which `moved` becomes as large as what `rest` leaves.
double least_time2(double moved, double rest) noexcept { return moved > 0 ? moved / rest : 0; }

double least_time2(const BodySettings& s, const BodySupport& support, const Wrench& rest,
                   const Wrench& moved) noexcept {
  double most = 0;
  for (const BodyEdge& edge : support) {
    const double room_m = edge.distance_m - s.edge_m;
    const auto beyond = [&](const Wrench& w) { return -edge.x * w[4] + edge.y * w[3] - room_m * w[2]; };
    most = std::max(most, least_time2(beyond(moved), std::max(-beyond(rest), least_room_m * rest[2])));
  }
  const double grip = s.friction / std::numbers::sqrt2;
  for (const Index k : {0, 1}) most = std::max(most, least_time2(std::abs(moved[k]) - grip * moved[2], grip * rest[2]));
  return most;
}

}  // namespace

WayTime time_of_way(const BodyLayout& layout, const BodySettings& settings, const BodySupport& support,
                    BodyGeometry& from, const Eigen::VectorXd& way, double time_s,
                    std::array<Eigen::VectorXd, 3>& scratch) noexcept {
  WayTime result;
  for (const JointAxis& axis : layout.joints) {
    const double way_rad = std::abs(way[from.base_size() + static_cast<Index>(axis.joint)]);
    const double least_s = peak_per_mean * way_rad / (settings.velocity_share * axis.velocity_max_rad_s);
    if (least_s > result.least_s) result = {least_s, 0.5 * time_s, axis.joint};
  }
  if (support.count == 0) return result;
  auto& [step, velocity, acceleration] = scratch;
  double gone = 0;
  bool failed = false;
  for (int i = 1; i <= way_points; ++i) {
    const double u = static_cast<double>(i) / (way_points + 1);
    const Curve at = minimum_jerk_at(u);
    step = (at.way - gone) * way;
    gone = at.way;
    from.move(step);
    from.update();
    velocity = at.speed * way;
    acceleration = at.acceleration * way;
    Wrench rest = Wrench::Zero();
    rest[2] = body_gravity_m_s2 * from.mass_kg();
    rest[3] = from.com_m()[1] * rest[2];
    rest[4] = -from.com_m()[0] * rest[2];
    const double least_s =
        std::sqrt(least_time2(settings, support, rest, from.ground_wrench(velocity, acceleration) - rest));
    if (least_s > result.least_s) result = {least_s, result.fails_after_s, no_body_joint};
    if (least_s > time_s && !failed) result.fails_after_s = u * time_s;
    failed = failed || least_s > time_s;
  }
  return result;
}

}  // namespace kadans
