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

double swing_way(double share) noexcept {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + 6 * s));
}

double swing_lift(double share) noexcept {
  constexpr double up = 0.4, down = 0.5;
  return share < down ? swing_way(share / up) : swing_way((1 - share) / (1 - down));
}

}  // namespace kadans
