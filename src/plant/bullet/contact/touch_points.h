// Where two convex shapes touch or soon will: at most four points, nearer than contact_distance_m, exact for boxes and
// spheres. Two boxes touch face to face wherever they can. The face is the one of least overlap, or that of the second
// box when the two differ little: so a foot on a box finds the box's own normal, however the foot tilts. The points are
// the corners of one face, cut off at the outline of the other. A cylinder touches a box's face with its rims; with
// edges and other cylinders it has one point, which Bullet computes. A hull touches a box's face with its corners, and
// all else as a cylinder does.
//
// Sources: separating axes and clipping, Ericson, Real-Time Collision Detection, sections 4.4.1 and 5.5.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <btBulletCollisionCommon.h>

namespace kadans::bullet {

inline constexpr double contact_distance_m = 0.01;

// A few of something, in order; what comes when it is full is left out.
template <typename T, std::size_t most>
class FixedList {
 public:
  static constexpr std::size_t capacity = most;

  void add(const T& one) {
    if (count_ < capacity) all_[count_++] = one;
  }
  std::size_t size() const { return count_; }
  const T& operator[](std::size_t place) const { return all_[place]; }
  T* begin() { return all_.data(); }
  T* end() { return all_.data() + count_; }
  const T* begin() const { return all_.data(); }
  const T* end() const { return all_.data() + count_; }

 private:
  std::array<T, most> all_{};
  std::size_t count_ = 0;
};

struct TouchPoint {
  btVector3 on_a, on_b;
  btVector3 normal;  // from b to a
  double distance_m = 0;
};

using TouchPoints = FixedList<TouchPoint, 4>;

TouchPoints touch_points(const btConvexShape& a, const btTransform& pose_a, const btConvexShape& b,
                         const btTransform& pose_b);

// Of points near a face, of which `axis` is the normal and `sign` its way outwards, those that carry: the deepest, the
// one furthest from it, and those that span the widest to both sides. Their places, in order; of up to four points all.
FixedList<std::size_t, TouchPoints::capacity> carrying(std::span<const btVector3> points, int axis, double sign);

inline constexpr std::size_t hull_corners_max = 64;  // of a link's hull; LinkShapes holds it

}  // namespace kadans::bullet
