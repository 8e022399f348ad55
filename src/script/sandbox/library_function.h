// Wraps functions of Lua's own library. The cost, in proportion to the arguments, is charged before the call, and the
// cost of the result after it. Functions that call back into the script may nest only to a bounded depth, because each
// level needs C stack. A function whose cost cannot be known beforehand is not forwarded but written anew with a
// StepMeter.
#pragma once

#include <cstdint>

#include <lua.hpp>

namespace kadans {

// [-0 +0] Replaces the field `name` of the table at the top of the stack by `function`, whose upvalue 1 is the old
// value.
void wrap(lua_State* state, const char* name, lua_CFunction function);

// [-0 +0] Sets the field `name` of the table at `table` to `function`.
void set_function(lua_State* state, int table, const char* name, lua_CFunction function);

// [-all +results] Calls upvalue 1 with the arguments on the stack.
int forward(lua_State* state);
// The same, and charges for the resulting string. A string has at most 64 kB (lua_heap.h), so it may be charged
// afterwards.
int forward_text(lua_State* state);

// To be called around other code that calls back. begin_callback raises. After an error the depth is restored where the
// error is caught.
void begin_callback(lua_State* state, const char* name);
void end_callback(lua_State* state) noexcept;

void charge_text(lua_State* state, double bytes);
// The instructions that compiling so many bytes of source costs.
constexpr double compiling_instructions(double bytes) noexcept { return 2 * bytes; }

// Converts a number to a position as LuaJIT does: a number that is no int becomes the smallest int.
std::int32_t to_place(lua_Number number) noexcept;
std::int32_t optional_place(lua_State* state, int index, std::int32_t otherwise);

}  // namespace kadans
