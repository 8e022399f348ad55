// Makes a Chart from the author's tables.
#pragma once

#include <lua.hpp>

#include "chart.h"

namespace kadans {

// Reads the behavior at `index` of the stack and all behaviors that it calls into `chart`. Functions and tables get
// registry references. Raises on anything that cannot be read; wrong names are found later by Chart::resolve().
void read_chart(lua_State* state, int index, Chart& chart);

}  // namespace kadans
