// The geometry of stepping, in the heading frame: where to put a foot, and where the centre of pressure can be.
//
// While one foot stands, the divergent component of motion xi runs away from the centre of pressure p: xi(t) = p + (xi
// - p) e^(w0 t). The swing foot is put where xi will be at that time, so that the next centre of pressure can hold xi
// (Pratt et al. 2006, Capture Point; Khadiv et al., arXiv 1609.09822). This needs no torque of the ankles' roll.
#pragma once

#include "kadans/signal/frames.h"

namespace kadans {

struct GroundPoint {
  double x_m = 0, y_m = 0;
};

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

// Distance from `point` to the point that split_load finds for it; 0 inside the hull.
double beyond_soles(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                    const GroundPoint& point) noexcept;

// xi after time_s, with a constant centre of pressure.
GroundPoint run_away(const GroundPoint& dcm, const GroundPoint& pressure, double rate_per_s, double time_s) noexcept;

// Of a swing, over the share of its time that has passed (0..1): its way, from 0 to 1 with rest at both ends, and its
// height, 0..1.
double swing_way(double share) noexcept;
double swing_lift(double share) noexcept;

}  // namespace kadans
