// What a behavior remembers, on its way from one Lua state to another.
#pragma once

#include <lua.hpp>

namespace kadans {

// Tables in tables: in vars, in what a machine copies of them, in what a reload or a file carries over.
inline constexpr int vars_depth_max = 16;

// [-0 +1 on `to`, -0 +0 on `from`] A deep copy of the value at `index` of `from`: plain data and the handles of
// motions. Raises in `to` on anything else; nothing is raised in `from`, whose stack may then hold more than before.
void push_copy_across(lua_State* from, int index, lua_State* to, int depth = 0);

}  // namespace kadans
