#include "step_geometry.h"

#include <algorithm>
#include <cmath>

namespace kadans {

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

double beyond_soles(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                    const GroundPoint& point) noexcept {
  const GroundPoint at = split_load(sole, left, right, point).at;
  return std::hypot(point.x_m - at.x_m, point.y_m - at.y_m);
}

GroundPoint run_away(const GroundPoint& dcm, const GroundPoint& pressure, double rate_per_s, double time_s) noexcept {
  const double growth = std::exp(rate_per_s * time_s);
  return {pressure.x_m + (dcm.x_m - pressure.x_m) * growth, pressure.y_m + (dcm.y_m - pressure.y_m) * growth};
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
