// How many slots a table has, empty ones too. To go through a table takes time in proportion to them, not to its
// elements, and a script may fill a table and empty it again; but Lua's API does not tell.
//
// So it is read where LuaJIT keeps it. The place is found by looking at tables of known sizes, in each state anew; when
// it is not found, a table counts as if it had all memory that one block may have.
#pragma once

#include <cstddef>

#include <lua.hpp>

namespace kadans {

class TableSlots {
 public:
  // [-0 +0] Raises when out of memory.
  void find_place(lua_State* state);
  // Steps (step_meter.h) that it takes to go through the table at `index` once.
  std::size_t steps(lua_State* state, int index) const noexcept;
  bool known() const noexcept { return place_ >= 0; }

 private:
  std::ptrdiff_t place_ = -1;  // in bytes from the table's address; -1: unknown
};

// Charges for going through the table at `index` once. Raises.
void charge_table(lua_State* state, int index);

}  // namespace kadans
