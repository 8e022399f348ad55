// Checks that `vars`, `args` and the arguments of k.call are plain data, because entering copies them and a reload
// keeps them. Anything else would raise as soon as the behavior is entered.
#pragma once

#include <vector>

#include "script/behavior/behavior_parts.h"

namespace kadans {

// `parts` is a loaded behavior.
void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems);

}  // namespace kadans
