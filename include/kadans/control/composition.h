// How several control objects share a joint. The objects of a set compute in the order of the set. Each object's
// proposal for a joint is combined with the result of the objects before it:
//
//   set       the proposal replaces the result
//   sum       the proposal's effort is added; the mode stays (a joint that is off takes the whole proposal)
//   blend     (1 - w) of the result and w of the proposal; w is a parameter of the set. Different modes do not mix: the
//             one with the larger weight is taken
//   priority  the proposal replaces the result while the object claims the joint: while the proposal is not off
//
// The safety layer applies its limits last, to the final result.
#pragma once

#include <cstdint>

#include "kadans/signal/frames.h"

namespace kadans {

enum class Composition : std::uint8_t { set, sum, blend, priority };

// Changes `actuation`, the result so far, to the new result. True when the proposal has a share in it. `weight` is used
// for blend only.
bool compose(Composition composition, double weight, const JointActuation& proposal,
             JointActuation& actuation) noexcept;

}  // namespace kadans
