// Skills: states with parameters that a library offers.
//
//   local arms = {}                                      arms.wave "hello" { times = 2,
//   arms.wave = k.skill "wave" {                           { on = "done", to = "over" },
//     doc  = "Waves with an arm",                        }
//     args = k.args { times = { 2, min = 1, max = 9 } },
//     make = function(a) return k.state "to_and_fro" { ... a.times ... } end,
//   }
//
// The state "hello" is the caller's: its mistakes, and wrong arguments, are told at the caller's line. Inside is the
// state that `make` returns. `make` gets all arguments, checked. The reference of behaviors lists the skills of
// behaviors/lib (script/bindings/api.h).
#pragma once

#include <lua.hpp>

namespace kadans {

// [-1 +1] Adds skill to the module's table at the top of the stack.
void open_skills(lua_State* state);

// [-0 +1 when true] True when the value at `index` is a skill; then its table { name =, doc =, args = } is pushed.
bool push_skill(lua_State* state, int index);

}  // namespace kadans
