// The geometry of stepping, in the heading frame: how a foot swings, when it has landed, and how two feet bear.
#pragma once

#include <cstddef>

#include "kadans/model/robot_model.h"

namespace kadans {

struct GroundPoint {
  double x_m = 0, y_m = 0;
};

// How far what collides of a foot reaches from its frame, with the foot flat.
struct FootShape {
  double front_m = 0, back_m = 0, side_m = 0, below_m = 0;
};
// Of the link, by its collision shapes. Throws std::invalid_argument when it has none, or none on all sides.
FootShape shape_of(const RobotModel& model, std::size_t foot);

// The usable part of a sole, without a margin at its edges, relative to the foot's frame.
struct Sole {
  double heel_m = 0.07, toe_m = 0.12;  // behind and before; > 0
  double half_width_m = 0.03;
  double middle_m() const noexcept { return (toe_m - heel_m) / 2; }
};

// How two feet share the load so that the centre of pressure is at one point of the hull of their parallel soles.
struct LoadSplit {
  double right_share = 0.5;
  GroundPoint in_sole;  // from a foot's frame, the same in both
  GroundPoint at;       // the point itself
};
// For the point that is nearest to `wanted`, or nearly so. `left` and `right` are the feet's frames.
LoadSplit split_load(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                     const GroundPoint& wanted) noexcept;

// Whether a foot that swings has landed: it bears more than touch_N for touch_s. One reading alone may be noise: the
// sum of four sensors with 2 N of it each passes 15 N in the air once in some minutes.
struct Touchdown {
  double held_s = 0;

  void look(double force_N, double touch_N, double dt_s) noexcept { held_s = force_N > touch_N ? held_s + dt_s : 0; }
  bool landed(double touch_s) const noexcept { return held_s > 0 && held_s > touch_s - 1e-9; }
};

// Of a swing, over the share of its time that has passed (0..1): its way, from 0 to 1 with rest at both ends, and its
// height, 0..1.
double swing_way(double share) noexcept;
double swing_lift(double share) noexcept;

}  // namespace kadans
