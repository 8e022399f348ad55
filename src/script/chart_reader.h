// From the author's tables to a Chart.
#pragma once

#include <lua.hpp>

#include "kadans/script/chart.h"

namespace kadans {

// The behavior at `index` becomes `chart`, what it calls included; functions and tables get registry references.
// Raises on what cannot be read; Chart::resolve() then finds wrong names.
void read_chart(lua_State* state, int index, Chart& chart);

}  // namespace kadans
