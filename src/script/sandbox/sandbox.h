// The names that a script sees, and functions that make tables read-only.
#pragma once

#include <cstdint>

#include <lua.hpp>

namespace kadans {

// Makes the sandbox's globals and stores them in the registry; push_environment() pushes them. Raises.
void open_sandbox(lua_State* state);
void push_environment(lua_State* state);

// [-1 +1] Replaces the table at the top of the stack by an empty table that reads from it. Writing raises, and reading
// an unknown field raises with the nearest name. `name` is the table's name in messages. Raises when out of memory.
void make_read_only(lua_State* state, const char* name, bool strict = true);
// [-0 +1 when true] Pushes the content behind a read-only table.
bool push_content(lua_State* state, int index);
// [-1 +0] The top of the stack is a function that fills a read-only content; the metatable of the content is below it.
// push_content() calls the function with one argument.
void set_filler(lua_State* state);
// Raises "NAME has no field 'x', did you mean 'y'?" for the key at `key`, from the names in the table at `content`.
int raise_unknown_field(lua_State* state, const char* name, int content, int key);

// The parts of the library:
void open_base(lua_State* state);  // [-0 +0] into the globals at the top
// [-0 +0] Puts pcall and xpcall into the table at `globals`, and resume and wrap into the coroutine library at the top.
void open_protected_calls(lua_State* state, int globals);
void open_math(lua_State* state);     // [-0 +0] into the math table at the top
void open_strings(lua_State* state);  // [-0 +0] wraps the functions in the string table at the top
void open_tables(lua_State* state);   // the same for the table library
int sandbox_pairs(lua_State* state);

// [-0 +0] Calls visit(key, value), two places on the stack, the value at its top, for the entries of the table at
// `index`, in the order of sandbox_pairs.
template <typename Visit>
void each_in_order(lua_State* state, int index, Visit visit) {
  luaL_checkstack(state, 8, "a table");
  lua_pushcfunction(state, sandbox_pairs);
  lua_pushvalue(state, index);
  lua_call(state, 1, 1);
  const int next = lua_gettop(state);
  for (;;) {
    lua_pushvalue(state, next);
    lua_call(state, 0, 2);
    if (lua_isnil(state, next + 1)) break;
    visit(next + 1, next + 2);
    lua_settop(state, next);
  }
  lua_settop(state, next - 1);
}

int sandbox_require(lua_State* state);
void open_kadans_module(lua_State* state);  // [-0 +1]

// Wraps functions of Lua's own library. The cost, in proportion to the arguments, is charged before the call, and the
// cost of the result after it. Functions that call back into the script may nest only to a bounded depth, because each
// level needs C stack. A function whose cost cannot be known beforehand is not forwarded but written anew with a
// StepMeter.

// [-0 +0] Replaces the field `name` of the table at the top of the stack by `function`, whose upvalue 1 is the old
// value.
void wrap(lua_State* state, const char* name, lua_CFunction function);

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
