// Where a robot on flat ground keeps its balance: the convex hull of the soles that stand, as half planes.
//
// A joint without a motor between a foot and the body lets the foot tilt about its axis as it likes. The ground then
// presses below this axis, and not at the sole's edges beside it: of two such feet, only the lines below their axes
// bear.
//
// And its spring presses the sole's edge down when the joint is bent: it may be bent only as far as what the foot bears
// keeps the sole flat.
//
// Any thread. Nothing allocates or throws.
#pragma once

#include "body_layout.h"
#include "kadans/model/robot_model.h"

namespace kadans {

struct BodyEdge {  // x * px + y * py <= distance of a point p on the ground; (x, y) is of length 1 and points outward
  double x = 0, y = 0, distance_m = 0;
};

struct BodySupport {
  std::array<BodyEdge, 4 * body_feet_max> edges{};
  std::size_t count = 0;
  const BodyEdge* begin() const noexcept { return edges.data(); }
  const BodyEdge* end() const noexcept { return edges.data() + count; }
};

// `feet`: the poses of the feet's frames, nullptr for one that does not stand. No edge without a foot.
BodySupport support_of(const BodyLayout& layout, const BodySettings& settings,
                       const std::array<const Pose*, body_feet_max>& feet) noexcept;

// How far the joint without a motor of this foot may be bent when the foot bears this much: the sole stays flat.
double bent_max_rad(const BodyLayout& layout, const BodySettings& settings, std::size_t foot, double load_N) noexcept;
// What the foot must bear when the joint is bent by this much.
double bent_load_N(const BodyLayout& layout, const BodySettings& settings, std::size_t foot, double bent_rad) noexcept;

}  // namespace kadans
