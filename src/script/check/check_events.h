// Finds transitions on an event that is never emitted: neither by a function of the behavior or of the files that it
// requires and calls, nor by a final state inside the waiting state.
#pragma once

#include <vector>

#include "check_modules.h"
#include "script/chart/chart.h"

namespace kadans {

void check_events(const Chart& chart, const std::vector<ReadSource>& read, std::vector<InputProblem>& problems);

}  // namespace kadans
