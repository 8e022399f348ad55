#include "hull.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <LinearMath/btConvexHullComputer.h>

namespace kadans {
namespace {

constexpr double flat_share = 1e-6;  // of the extent: what is thinner has no inside

Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct Plane {
  Point normal;  // of length 1, outwards
  double distance;
};

// The points at which Bullet's hull has its corners, without those that are given twice.
std::vector<Point> exact_corners(const std::vector<Point>& points) {
  btConvexHullComputer computer;
  computer.compute(points.front().data(), sizeof(Point), static_cast<int>(points.size()), 0, 0);
  std::vector<Point> corners;
  for (int i = 0; i < computer.original_vertex_index.size(); ++i)
    corners.push_back(points[static_cast<std::size_t>(computer.original_vertex_index[i])]);
  std::ranges::sort(corners);
  const auto twice = std::ranges::unique(corners);
  corners.erase(twice.begin(), twice.end());
  return corners;
}

std::vector<Plane> faces_of(const std::vector<Point>& corners) {
  btConvexHullComputer computer;
  computer.compute(corners.front().data(), sizeof(Point), static_cast<int>(corners.size()), 0, 0);
  Point middle{};
  for (const Point& corner : corners) {
    for (std::size_t i = 0; i < 3; ++i) middle[i] += corner[i] / static_cast<double>(corners.size());
  }
  std::vector<Plane> faces;
  for (int i = 0; i < computer.faces.size(); ++i) {
    const auto* const first = &computer.edges[computer.faces[i]];
    const auto* const second = first->getNextEdgeOfFace();
    const auto at = [&](int vertex) {
      return corners[static_cast<std::size_t>(computer.original_vertex_index[vertex])];
    };
    const Point a = at(first->getSourceVertex());
    Point normal = cross(at(first->getTargetVertex()) - a, at(second->getTargetVertex()) - a);
    const double length = std::sqrt(dot(normal, normal));
    if (!(length > 0)) continue;
    const double sign = dot(normal, a - middle) < 0 ? -1 : 1;
    for (double& part : normal) part *= sign / length;
    faces.push_back({normal, dot(normal, a)});
  }
  return faces;
}

class Reduction {
 public:
  Reduction(const std::vector<Point>& all, std::size_t corners_max) : all_(all), taken_(all.size(), false) {
    begin();
    while (hull_.size() < corners_max) {
      const auto [index, outside] = furthest();
      left_out_ = outside;
      if (!(outside > flat_share * extent_)) return;
      take(index);
    }
    left_out_ = furthest().second;
  }

  const std::vector<Point>& hull() const { return hull_; }
  double left_out() const { return std::max(left_out_, 0.0); }

 private:
  void begin() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::ranges::minmax_element(all_, {}, [&](const Point& point) { return point[axis]; });
      extent_ = std::max(extent_, (*high)[axis] - (*low)[axis]);
    }
    // Two that are far apart, the one furthest from their line, the one furthest from the plane of the three.
    take(0);
    take(most([&](const Point& p) { return dot(p - hull_[0], p - hull_[0]); }));
    take(most([&](const Point& p) {
      const Point side = cross(p - hull_[0], hull_[1] - hull_[0]);
      return dot(side, side);
    }));
    const Point normal = cross(hull_[1] - hull_[0], hull_[2] - hull_[0]);
    take(most([&](const Point& p) { return std::abs(dot(normal, p - hull_[0])); }));
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
      for (const Plane& face : faces) outside = std::max(outside, dot(face.normal, all_[i]) - face.distance);
      if (outside > result.second) result = {i, outside};
    }
    return result;
  }

  const std::vector<Point>& all_;
  std::vector<bool> taken_;
  std::vector<Point> hull_;
  double extent_ = 0, left_out_ = 0;
};

}  // namespace

Hull convex_hull(const std::vector<Point>& points, std::size_t corners_max) {
  const std::vector<Point> all = exact_corners(points);
  if (all.size() <= corners_max) return {all, all.size(), 0};
  const Reduction reduction(all, corners_max);
  return {reduction.hull(), all.size(), reduction.left_out()};
}

}  // namespace kadans
