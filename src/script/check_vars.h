// `vars`, `args` and what a k.call gives: plain data, which an entry copies and a reload keeps. Anything else raises as
// soon as the behavior is entered.
#pragma once

#include <vector>

#include "behavior_parts.h"

namespace kadans {

// Of a behavior that is loaded.
void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems);

}  // namespace kadans
