// The names that tests of behaviors see beside what scripts see.
#pragma once

#include <lua.hpp>

namespace kadans {

// [-5 +0] What stands at the top becomes describe, it, before_each, expect and k.play, in this order.
void open_test_names(lua_State* state);

}  // namespace kadans
