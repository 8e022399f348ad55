// What a call gives to the behavior that it calls: k.call "squat" { depth_m = 0.12, side = "left" }.
//
// A value of a parameter counts in this call alone, and there it counts more than everything else: the file's default,
// the robot's, and what is set while the behavior plays. A parameter of the caller that is given is followed: it is
// looked up whenever the callee reads its own. So its range must fit into the callee's. Functions are evaluated when
// the callee is entered, in the state that calls; arguments have their values from then on.
#pragma once

#include <cstdint>

#include <lua.hpp>

#include "chart.h"
#include "script/lua/script_error.h"

namespace kadans {

struct Bindings;
struct LuaCore;

// [-0 +0] Reads what a call gives to the behavior that is `machine`, from the table at `given`: values of its arguments
// and parameters, each a constant, a parameter of the caller or a function. Raises at the call's `place`.
void read_given(lua_State* state, Chart& chart, std::size_t machine, int given, const ScriptPlace& place);

// The value that a parameter has in a machine.
double parameter_value(lua_State* state, std::size_t number, std::uint16_t machine,
                       std::size_t* looked = nullptr) noexcept;
// The same, charged by what it looks at: a call may hand on what its own caller gave it. Raises.
double charged_value(lua_State* state, std::size_t number, std::uint16_t machine);
// The same, in the machine whose function runs.
double value_here(lua_State* state, std::size_t number);

// Before the first tick: the place of the values that functions give. Until then it holds the parameters' own.
void make_room_for_calls(const LuaCore& core, const Chart& chart, Bindings& bindings);

// [-0 +1 when true] Whether the value at the top of the stack cannot be given so; a text says why.
bool push_given_refusal(lua_State* state, const Chart::Machine& machine, const Chart::Given& given);

}  // namespace kadans
