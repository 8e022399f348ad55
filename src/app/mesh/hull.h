// The convex hull of points, with few corners.
#pragma once

#include <cstddef>
#include <vector>

#include <LinearMath/btVector3.h>

namespace kadans {

// At most `corners_max` >= 4 of them: the hull begins with four points that are far apart and takes, one after another,
// the point that is furthest outside of it, as quickhull does (Barber, Dobkin, Huhdanpaa 1996). So it lies within the
// exact one. At least one point, all finite.
std::vector<btVector3> convex_hull(const std::vector<btVector3>& points, std::size_t corners_max);

}  // namespace kadans
