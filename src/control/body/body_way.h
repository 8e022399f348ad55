// How long a robot that stands needs at least for the way from one posture to another, so that it neither topples nor
// slips on it, and no joint is too fast.
//
// The way is straight in all degrees of freedom, and is gone like a motion of the engine, along a minimum-jerk curve.
// On a given way the wrench that the ground must give is that of rest plus one that goes with 1 / time^2. So in each of
// its points the time in which the zero moment point (Vukobratovic and Borovac 2004, IJHR 1(1)) comes to an edge of the
// soles follows from two wrenches: no search, and no simulation in small steps.
//
// Any thread. Nothing allocates or throws.
#pragma once

#include "body_geometry.h"
#include "body_support.h"

namespace kadans {

struct WayTime {
  double least_s = 0;                 // for the whole way; 0: any time will do
  double fails_after_s = 0;           // in the time that was asked for, it topples, slips or is too fast from here on
  std::size_t joint = no_body_joint;  // the one that would be too fast: it needs longest
};

// From the posture of `from` on by `way`, a generalised velocity times a time, in time_s. Moves `from` along the way;
// `scratch` are vectors of its size.
WayTime time_of_way(const BodyLayout& layout, const BodySettings& settings, const BodySupport& support,
                    BodyGeometry& from, const Eigen::VectorXd& way, double time_s,
                    std::array<Eigen::VectorXd, 3>& scratch) noexcept;

}  // namespace kadans
