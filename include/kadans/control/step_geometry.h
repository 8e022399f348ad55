// Where to put a foot, and where the ground can bear: the geometry of stepping, in the heading frame.
//
// While one foot stands, the divergent component of motion runs away from the centre of pressure p:
// xi(t) = p + (xi - p) e^(w0 t). The foot that comes down is put where xi will be then, so that the next centre of
// pressure can hold it (Pratt et al. 2006, Capture GroundPoint; Khadiv et al., arXiv 1609.09822: it needs no torque
// about the ankles' roll).
#pragma once

#include "kadans/signal/frames.h"

namespace kadans {

struct GroundPoint {
  double x_m = 0, y_m = 0;
};

// The sole about its foot's frame, a margin taken off.
struct Sole {
  double heel_m = 0.07, toe_m = 0.12;  // behind and before; > 0
  double half_width_m = 0.03;
  double middle_m() const noexcept { return (toe_m - heel_m) / 2; }
};

// The point of the hull of two parallel soles that is nearest to `wanted`, or nearly so: how much of the load the right
// foot bears, and where in the sole of each.
struct LoadSplit {
  double right_share = 0.5;
  GroundPoint in_sole;  // from a foot's frame, the same in both
  GroundPoint at;       // the point itself
};
LoadSplit split_load(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                     const GroundPoint& wanted) noexcept;

// How far `point` is from that hull; 0 inside.
double beyond_soles(const Sole& sole, const GroundPoint& left, const GroundPoint& right,
                    const GroundPoint& point) noexcept;

// xi after time_s about a centre of pressure that stays.
GroundPoint run_away(const GroundPoint& dcm, const GroundPoint& pressure, double rate_per_s, double time_s) noexcept;

// A swing from 0 to 1 that begins and ends at rest, and its height, 0..1, both over the share of time, 0..1.
double swing_way(double share) noexcept;
double swing_lift(double share) noexcept;

}  // namespace kadans
