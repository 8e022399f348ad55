// How several control objects share a joint. Objects of a set compute in its order; each one's proposal for a joint is
// composed with what the ones before it made of that joint:
//
//   set       replaces it
//   sum       adds its effort; the mode stays (a joint that is off takes the proposal's mode)
//   blend     (1 - w) of what was there and w of the proposal, w being a parameter of the set; in different modes there
//             is nothing between: the heavier one writes
//   priority  replaces it while the object claims the joint, that is while its proposal is not off
//
// The limits of the safety layer come last, over whatever was composed.
#pragma once

#include <cstdint>

#include "kadans/signal/frames.h"

namespace kadans {

enum class Composition : std::uint8_t { set, sum, blend, priority };

// True when the proposal has a share in what stands in `actuation` now. `weight` counts for blend alone.
bool compose(Composition composition, double weight, const JointActuation& proposal,
             JointActuation& actuation) noexcept;

}  // namespace kadans
