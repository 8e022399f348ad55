// The additional names that tests of behaviors see.
#pragma once

#include <lua.hpp>

namespace kadans {

// [-5 +0] Makes the five values at the top of the stack the names describe, it, before_each, expect and k.play, in this
// order.
void open_test_names(lua_State* state);

}  // namespace kadans
