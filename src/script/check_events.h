// Transitions on an event that nobody emits: no function of the behavior and of what it requires and calls, and no
// state that ends inside the one that waits.
#pragma once

#include <vector>

#include "check_modules.h"
#include "kadans/script/chart.h"

namespace kadans {

void check_events(const Chart& chart, const std::vector<ReadSource>& read, std::vector<InputProblem>& problems);

}  // namespace kadans
