// The convex hull of points, with few corners.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace kadans {

using Point = std::array<double, 3>;

struct Hull {
  std::vector<Point> corners;  // points that were given
  std::size_t exact = 0;       // how many corners it has when none is left out
  double left_out = 0;         // no point that was given is further outside; 0: none is
};

// At most `corners_max` >= 4 of them: the hull begins with four points that are far apart and takes, one after another,
// the point that is furthest outside of it, as quickhull does (Barber, Dobkin, Huhdanpaa 1996). So it lies within the
// exact one. At least one point, all finite.
Hull convex_hull(const std::vector<Point>& points, std::size_t corners_max);

}  // namespace kadans
