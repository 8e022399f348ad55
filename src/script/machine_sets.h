// The control sets that the machines of a behavior run on: a called one's own, or its caller's. Those that can be
// active at the same time are the same or have no joint in common.
#pragma once

#include <string>

#include "behavior_parts.h"

namespace kadans {

// Fills the bindings' sets; what cannot be is added to the parts' problems.
void find_control_sets(Behavior::Parts& parts);

// "control sets 'posture' and 'arms' both drive joint 'l_shoulder_pitch'"; "" when none of `a` and `b` do.
std::string clash_text(const Catalog& catalog, SetMask a, SetMask b);

}  // namespace kadans
