// Finds the source line of each transition of a chart. The tables from which the chart was read do not know the lines,
// so the source is searched. A transition that is not written as { ... to = "name" ... } in the braces of its state
// keeps the line that it has.
#pragma once

#include <vector>

#include "chart.h"
#include "script/lua/lua_state.h"

namespace kadans {

void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart);

}  // namespace kadans
