// Which line each transition of a chart is written in: the table that the chart was read from does not know, so the
// source is looked at. What is not written out, { ... to = "name" ... } in the braces of its state, keeps the line that
// it has.
#pragma once

#include <vector>

#include "kadans/script/chart.h"
#include "kadans/script/lua_state.h"

namespace kadans {

void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart);

}  // namespace kadans
