// Makes a Chart from the author's tables.
#pragma once

#include <vector>

#include <lua.hpp>

#include "chart.h"
#include "script/lua/lua_state.h"

namespace kadans {

// Reads the behavior at `index` of the stack and all behaviors that it calls into `chart`. Functions and tables get
// registry references. Raises on anything that cannot be read; wrong names are found later by Chart::resolve().
void read_chart(lua_State* state, int index, Chart& chart);

// Finds the source line of each transition of a chart. The tables from which the chart was read do not know the lines,
// so the source is searched. A transition that is not written as { ... to = "name" ... } in the braces of its state
// keeps the line that it has.
void find_transition_lines(const std::vector<LuaState::Source>& sources, Chart& chart);

}  // namespace kadans
