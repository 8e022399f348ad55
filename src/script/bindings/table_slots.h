// Finds the number of slots of a table, empty ones included. The time to go through a table is proportional to its
// slots, not to its elements, and a script may fill a table and empty it again. Lua's API does not give this number.
//
// So it is read from LuaJIT's own data. Its place is found in each state by comparing tables of known sizes. When the
// place is not found, every table counts as if it filled the largest allowed block of memory.
#pragma once

#include <cstddef>

#include <lua.hpp>

namespace kadans {

class TableSlots {
 public:
  // [-0 +0] Raises when out of memory.
  void find_place(lua_State* state);
  // The steps (step_meter.h) to go through the table at `index` once.
  std::size_t steps(lua_State* state, int index) const noexcept;
  bool known() const noexcept { return place_ >= 0; }

 private:
  std::ptrdiff_t place_ = -1;  // in bytes from the table's address; -1: unknown
};

// Charges for going through the table at `index` once. Raises.
void charge_table(lua_State* state, int index);

}  // namespace kadans
