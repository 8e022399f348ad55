// Finds mistakes in the shape of a chart that could still run: states that cannot be reached, states without a way out,
// final states without an outcome, transitions that can never be taken.
#pragma once

#include <vector>

#include "check_source.h"
#include "script/behavior/behavior_parts.h"
#include "script/chart/chart.h"

namespace kadans {

// The chart must be resolved and free of other problems.
void check_chart(const Chart& chart, std::vector<InputProblem>& problems);

// Finds transitions on an event that is never emitted: neither by a function of the behavior or of the files that it
// requires and calls, nor by a final state inside the waiting state.
void check_events(const Chart& chart, const std::vector<ReadSource>& read, std::vector<InputProblem>& problems);

// Checks that `vars`, `args` and the arguments of k.call are plain data, because entering copies them and a reload
// keeps them. Anything else would raise as soon as the behavior is entered.
// `parts` is a loaded behavior.
void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems);

}  // namespace kadans
