// Finds mistakes in the shape of a chart that could still run: states that cannot be reached, states without a way out,
// final states without an outcome, transitions that can never be taken.
#pragma once

#include <vector>

#include "script/chart/chart.h"

namespace kadans {

// The chart must be resolved and free of other problems.
void check_chart(const Chart& chart, std::vector<InputProblem>& problems);

}  // namespace kadans
