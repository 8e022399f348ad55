// Copies the vars of a behavior from one Lua state to another.
#pragma once

#include <lua.hpp>

namespace kadans {

// The greatest depth of nested tables in vars, in copies of them, and in what a reload or a file carries over.
inline constexpr int vars_depth_max = 16;

// [-0 +1 on `to`, -0 +0 on `from`] Pushes a deep copy of the value at `index` of `from`: plain data and handles of
// motions. Raises in `to` on anything else; then the stack of `from` may hold more than before. Never raises in `from`.
void push_copy_across(lua_State* from, int index, lua_State* to, int depth = 0);

}  // namespace kadans
