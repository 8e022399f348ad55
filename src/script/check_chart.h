// Mistakes in the shape of a chart that runs all the same: states that nothing leads to, states that nothing leads out
// of, finals that do not say how it ended, transitions that are never looked at.
#pragma once

#include <vector>

#include "kadans/script/chart.h"

namespace kadans {

// The chart is resolved and free of other problems.
void check_chart(const Chart& chart, std::vector<InputProblem>& problems);

}  // namespace kadans
