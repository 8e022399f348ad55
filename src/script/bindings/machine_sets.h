// Finds the control sets that the states of a behavior run on: those that a state names, else those of the state around
// it, also across a call. Sets that can be active at the same time must be the same or have no joint in common.
#pragma once

#include <array>
#include <string>

#include "script/behavior/behavior_parts.h"

namespace kadans {

// Fills the sets of the chart's states and those of the bindings. Impossible combinations are added to the parts'
// problems.
void find_control_sets(Behavior::Parts& parts);

// "control sets 'posture' and 'arms' both drive joint 'l_shoulder_pitch'"; "" when no set of `a` shares a joint with
// one of `b`.
std::string clash_text(const Catalog& catalog, SetMask a, SetMask b);

// What is wrong where an object is used that is in none of a machine's control sets, or in none of a state's. No C++
// object is alive when Lua raises.
using SetMessage = std::array<char, 512>;
SetMessage not_in_sets(const Bindings& bindings, const std::string& object, std::size_t machine);
SetMessage not_in_sets(const Bindings& bindings, std::uint32_t object, const Chart::State& state);

}  // namespace kadans
