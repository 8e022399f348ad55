// Names that a behavior's functions use and nobody knows, found by reading its text, whatever branch they stand in:
// fields of m and s, control objects, set-points, presets, parameters, poses, vars, globals, own modules; values out of
// range; guards that write or return nothing; waits where nothing can wait; events that nobody emits.
#pragma once

#include <vector>

#include "known_names.h"

namespace kadans {

// Of a behavior that is loaded: its file and all that it requires and calls. `known` learns what the files give
// modules.
void check_sources(const Behavior::Parts& parts, KnownNames& known, std::vector<InputProblem>& problems);

}  // namespace kadans
