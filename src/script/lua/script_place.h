// The messages of bindings: a place in a script, errors raised at it, and the check of a table's keys.
#pragma once

#include <lua.hpp>

namespace kadans {

struct ScriptPlace {
  const char* chunk = "";  // lives as long as the Lua state
  int line = 0;
};

// The place in the script function that calls the running C function; `level` 1 is the direct caller.
ScriptPlace calling_place(lua_State* state, int level = 1);
// Raises "file:line: message". With `needle`, the line is the first one from the place on that contains this text.
int raise_at(lua_State* state, const ScriptPlace& place, const char* needle, const char* format, ...);

// [-0 +0] Raises with the nearest name when the table at `table` has a string key that is not among `names`, which end
// with nullptr. `what` is the name of the table in messages.
void check_keys(lua_State* state, int table, const ScriptPlace& place, const char* what, const char* const* names);

}  // namespace kadans
