#include "hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <LinearMath/btConvexHullComputer.h>

namespace kadans {
namespace {

constexpr double flat_share = 1e-6;  // of the extent: what is thinner has no inside

struct Plane {
  btVector3 normal;  // of length 1, outwards
  double distance;
};

void compute(btConvexHullComputer& computer, const std::vector<btVector3>& points) {
  computer.compute(points.front().m_floats, sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
}

// The points at which Bullet's hull has its corners.
std::vector<btVector3> exact_corners(const std::vector<btVector3>& points) {
  btConvexHullComputer computer;
  compute(computer, points);
  std::vector<btVector3> corners;
  for (int i = 0; i < computer.original_vertex_index.size(); ++i)
    corners.push_back(points[static_cast<std::size_t>(computer.original_vertex_index[i])]);
  return corners;
}

std::vector<Plane> faces_of(const std::vector<btVector3>& corners) {
  btConvexHullComputer computer;
  compute(computer, corners);
  btVector3 middle(0, 0, 0);
  for (const btVector3& corner : corners) middle += corner / static_cast<double>(corners.size());
  std::vector<Plane> faces;
  for (int i = 0; i < computer.faces.size(); ++i) {
    const auto* const first = &computer.edges[computer.faces[i]];
    const auto* const second = first->getNextEdgeOfFace();
    const auto at = [&](int vertex) {
      return corners[static_cast<std::size_t>(computer.original_vertex_index[vertex])];
    };
    const btVector3 a = at(first->getSourceVertex());
    const btVector3 across = (at(first->getTargetVertex()) - a).cross(at(second->getTargetVertex()) - a);
    if (!(across.length() > 0)) continue;
    const btVector3 normal = (across.dot(a - middle) < 0 ? -across : across) / across.length();
    faces.push_back({normal, normal.dot(a)});
  }
  return faces;
}

class Reduction {
 public:
  Reduction(const std::vector<btVector3>& all, std::size_t corners_max) : all_(all), taken_(all.size(), false) {
    begin();
    while (hull_.size() < corners_max) {
      const auto [index, outside] = furthest();
      if (!(outside > flat_share * extent_)) return;
      take(index);
    }
  }

  const std::vector<btVector3>& hull() const { return hull_; }

 private:
  void begin() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] =
          std::ranges::minmax_element(all_, {}, [&](const btVector3& point) { return point[axis]; });
      extent_ = std::max(extent_, (*high)[axis] - (*low)[axis]);
    }
    // Two that are far apart, the one furthest from their line, the one furthest from the plane of the three.
    take(0);
    take(most([&](const btVector3& p) { return (p - hull_[0]).length2(); }));
    take(most([&](const btVector3& p) { return (p - hull_[0]).cross(hull_[1] - hull_[0]).length2(); }));
    const btVector3 normal = (hull_[1] - hull_[0]).cross(hull_[2] - hull_[0]);
    take(most([&](const btVector3& p) { return std::abs(normal.dot(p - hull_[0])); }));
  }

  template <typename Measure>
  std::size_t most(Measure&& measure) const {
    return static_cast<std::size_t>(std::ranges::max_element(all_, {}, measure) - all_.begin());
  }

  void take(std::size_t index) {
    if (taken_[index]) return;
    taken_[index] = true;
    hull_.push_back(all_[index]);
  }

  // The point that is furthest outside, and how far.
  std::pair<std::size_t, double> furthest() const {
    const std::vector<Plane> faces = faces_of(hull_);
    std::pair<std::size_t, double> result{0, 0};
    for (std::size_t i = 0; i < all_.size(); ++i) {
      if (taken_[i]) continue;
      double outside = -std::numeric_limits<double>::infinity();
      for (const Plane& face : faces) outside = std::max(outside, face.normal.dot(all_[i]) - face.distance);
      if (outside > result.second) result = {i, outside};
    }
    return result;
  }

  const std::vector<btVector3>& all_;
  std::vector<bool> taken_;
  std::vector<btVector3> hull_;
  double extent_ = 0;
};

}  // namespace

std::vector<btVector3> convex_hull(const std::vector<btVector3>& points, std::size_t corners_max) {
  const std::vector<btVector3> all = exact_corners(points);
  return all.size() <= corners_max ? all : Reduction(all, corners_max).hull();
}

}  // namespace kadans
