// Arguments: what a behavior, or a skill of a library, is given when it is called. They are declared as parameters are,
//
//   args = k.args {
//     depth_m = { 0.1, min = 0.02, max = 0.2, unit = "m", doc = "how far down" },
//     side    = { "left", one_of = { "left", "right" } },
//     again   = { false },
//   }
//
// and the default tells the type: a number, a text, true or false, or a table of plain data, which only k.call can
// give. The same check serves k.call, skills, and lists of behaviors.
#pragma once

#include <string>
#include <vector>

#include <lua.hpp>

#include "script/host/script_declarations.h"
#include "script/lua/script_error.h"

namespace kadans {

// [-0 +1] Checks the declarations in the table at `index` and pushes a copy of them: name -> { default, min = ... }.
// What k.args returned is taken as it is. Raises.
void push_declarations(lua_State* state, int index, const ScriptPlace& place);
// [-0 +1] The declarations of the file `chunk`, made by k.args; nil when there are none.
void push_file_declarations(lua_State* state, const char* chunk);

// [-0 +1 when true] True when the value at `value` is not what the declaration at `declared` allows; then a text says
// why. `of` is who takes it: "behavior 'squat'".
bool push_refusal(lua_State* state, int declared, int value, const char* name, const char* of);

// [-0 +1 when true] The same for all values that a parameter may have: the argument follows it.
bool push_followed_refusal(lua_State* state, int declared, const ScriptParameter& parameter, const char* name,
                           const char* of);

// [-0 +0] The text in the field `key` of the table at `table`; "" when it is none.
std::string text_of_field(lua_State* state, int table, const char* key);

// [-0 +0] The declarations in the table at `index`, by name.
std::vector<ScriptArgument> read_declarations(lua_State* state, int index);

// [-1 +1] Adds args to the module's table at the top of the stack.
void open_arguments(lua_State* state);

}  // namespace kadans
