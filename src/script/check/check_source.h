// Finds mistakes by reading the text of a behavior, in every branch: unknown names (fields of m and s, control objects,
// set-points, presets, parameters, poses, vars, globals, own modules), values out of range, guards that write or return
// nothing, waits in places that cannot wait, and events that are never emitted.
#pragma once

#include <vector>

#include "known_names.h"

namespace kadans {

// Checks the file of a loaded behavior and all files that it requires and calls. Fields that the files assign to
// modules are added to `known`.
void check_sources(const Behavior::Parts& parts, KnownNames& known, std::vector<InputProblem>& problems);

}  // namespace kadans
