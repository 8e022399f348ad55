// Functions of Lua's own library, wrapped: what one may cost is charged before it begins, what it made is charged
// after, and those that call back into the script nest only so deep, since each takes a piece of the C stack.
#pragma once

#include <lua.hpp>

namespace kadans {

// [-0 +0] The field `name` of the table at the top becomes `function`, with what was there as upvalue 1.
void wrap(lua_State* state, const char* name, lua_CFunction function);

// [-all +results] Calls upvalue 1 with the arguments on the stack.
int forward(lua_State* state);
// The same, and charges for the string it made. A string takes at most 64 kB (lua_heap.h), so this may come late.
int forward_text(lua_State* state);
// The same as forward, for a function that calls back; `name` is for the message when that is nested too deeply.
int forward_nested(lua_State* state, const char* name);

// Around other code that calls back. Raises. What an error leaves behind is mended where errors are caught.
void begin_callback(lua_State* state, const char* name);
void end_callback(lua_State* state) noexcept;

void charge_text(lua_State* state, double bytes);

}  // namespace kadans
