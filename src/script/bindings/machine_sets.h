// Finds the control sets that a behavior's machines run on: a called machine has its own set or its caller's. Sets that
// can be active at the same time must be the same or have no joint in common.
#pragma once

#include <string>

#include "script/behavior/behavior_parts.h"

namespace kadans {

// Fills the bindings' sets. Impossible combinations are added to the parts' problems.
void find_control_sets(Behavior::Parts& parts);

// "control sets 'posture' and 'arms' both drive joint 'l_shoulder_pitch'"; "" when no set of `a` shares a joint with
// one of `b`.
std::string clash_text(const Catalog& catalog, SetMask a, SetMask b);

}  // namespace kadans
