// Functions of Lua's own library, wrapped: what one costs, in proportion to its arguments, is charged before it begins,
// what it made is charged after, and those that call back into the script nest only so deep, since each takes a piece
// of the C stack. What cannot be known beforehand is not forwarded but written anew, with a StepMeter.
#pragma once

#include <cstdint>

#include <lua.hpp>

namespace kadans {

// [-0 +0] The field `name` of the table at the top becomes `function`, with what was there as upvalue 1.
void wrap(lua_State* state, const char* name, lua_CFunction function);

// [-0 +0] The field `name` of the table at `table` becomes `function`.
void set_function(lua_State* state, int table, const char* name, lua_CFunction function);

// [-all +results] Calls upvalue 1 with the arguments on the stack.
int forward(lua_State* state);
// The same, and charges for the string it made. A string takes at most 64 kB (lua_heap.h), so this may come late.
int forward_text(lua_State* state);

// Around other code that calls back. Raises. What an error leaves behind is mended where errors are caught.
void begin_callback(lua_State* state, const char* name);
void end_callback(lua_State* state) noexcept;

void charge_text(lua_State* state, double bytes);
// What it takes to compile so much of a source.
constexpr double compiling_instructions(double bytes) noexcept { return 2 * bytes; }

// As LuaJIT reads a number that stands for a place: what is no int is the smallest one.
std::int32_t to_place(lua_Number number) noexcept;
std::int32_t optional_place(lua_State* state, int index, std::int32_t otherwise);

}  // namespace kadans
