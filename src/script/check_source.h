// Names that a behavior's functions use and nobody knows, found by reading its text, whatever branch they stand in:
// fields of m and s, control objects, set-points, presets, parameters, poses, vars, globals; values out of range; and
// guards that write.
#pragma once

#include <vector>

#include "known_names.h"

namespace kadans {

// Of a behavior that is loaded: its file and all that it requires and calls.
void check_sources(const Behavior::Parts& parts, const KnownNames& known, std::vector<InputProblem>& problems);

}  // namespace kadans
