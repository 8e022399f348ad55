#include "chart_calls.h"

#include <algorithm>
#include <cmath>

#include <lua.hpp>

#include "chart_arguments.h"
#include "chart_reader.h"
#include "chart_runner.h"
#include "script/bindings/bindings.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr int given_max = 100;                // of one call
constexpr double given_instructions = 0.125;  // to look at one of them for a parameter

// The parameter of this name that the file declares; none: no_parameter.
std::int32_t declared_parameter(const LuaCore& core, const std::string& chunk, const char* name) {
  const auto found = std::ranges::find_if(
      core.parameters, [&](const ScriptParameter& one) { return one.name == name && one.chunk == chunk; });
  return found == core.parameters.end() ? Chart::no_parameter
                                        : static_cast<std::int32_t>(found - core.parameters.begin());
}

// [-0 +1 when true] Whether the value at the top of the stack cannot be that of the parameter; a text says why.
bool push_refused_value(lua_State* state, const ScriptParameter& parameter, const char* of) {
  const char* name = parameter.name.c_str();
  if (lua_type(state, -1) != LUA_TNUMBER)
    return lua_pushfstring(state, "parameter '%s' of behavior '%s' is a number", name, of), true;
  const double value = lua_tonumber(state, -1);
  if (value >= parameter.min && value <= parameter.max) return false;
  lua_pushfstring(state, "parameter '%s' of behavior '%s' = %f is outside its range %f..%f%s%s", name, of, value,
                  parameter.min, parameter.max, parameter.unit.empty() ? "" : " ", parameter.unit.c_str());
  return true;
}

struct CallReader {
  lua_State* state;
  Chart& chart;
  std::size_t number;
  ScriptPlace place;
  int declared = 0;  // on the stack
  int constants = 0;

  const Chart::Machine& machine() const { return chart.machines[number]; }
  const ScriptParameter& parameter(std::int32_t which) const {
    return core_of(state).parameters[static_cast<std::size_t>(which)];
  }

  // The value at the top of the stack, under its key below it.
  void read() {
    if (lua_type(state, -2) != LUA_TSTRING)
      raise_at(state, place, machine().name.c_str(), "k.call takes values by their names: { depth_m = 0.1 }");
    const char* name = lua_tostring(state, -2);
    lua_getfield(state, declared, name);
    const bool argument = !lua_isnil(state, -1);
    lua_insert(state, -2);
    const std::int32_t its = declared_parameter(core_of(state), chart.states[machine().root].chunk, name);
    if (!argument && its == Chart::no_parameter) refuse_name(name);
    const int value = lua_gettop(state);
    const std::size_t* followed = to_parameter(state, value);
    if (followed != nullptr) check_followed(name, argument ? value - 1 : 0, its, *followed);
    if (followed == nullptr && !lua_isfunction(state, value)) return take_constant(name, argument, its);
    Chart::Given& given = add(name, argument ? Chart::no_parameter : its);
    if (followed != nullptr) {
      given.follows = static_cast<std::int32_t>(*followed);
    } else {
      lua_pushvalue(state, value);
      const int function = luaL_ref(state, LUA_REGISTRYINDEX);
      chart.machines[number].calls_with.back().function = function;
    }
    lua_remove(state, value - 1);
  }

  Chart::Given& add(const char* name, std::int32_t parameter) {
    auto& all = chart.machines[number].calls_with;
    if (all.size() >= given_max) raise_at(state, place, name, "k.call gives more than %d values", given_max);
    const int line = find_line(state, place, name);
    Chart::Given& given = all.emplace_back();
    given.name = name;
    given.parameter = parameter;
    given.line = line;
    return given;
  }

  // The declaration is below the value at the top.
  void take_constant(const char* name, bool argument, std::int32_t its) {
    const int value = lua_gettop(state);
    lua_pushvalue(state, value);
    const bool wrong =
        argument ? push_refused_argument(name, value) : push_refused_value(state, parameter(its), called());
    if (wrong) raise_at(state, place, name, "%s", lua_tostring(state, -1));
    if (argument) {
      lua_setfield(state, constants, name);
    } else {
      add(name, its).value = lua_tonumber(state, value);
    }
    lua_settop(state, value);
    lua_remove(state, value - 1);
  }

  const char* called() const { return machine().name.c_str(); }
  bool push_refused_argument(const char* name, int value) const {
    const char* of = lua_pushfstring(state, "behavior '%s'", called());
    const bool wrong = kadans::push_refusal(state, value - 1, value, name, of);
    lua_remove(state, wrong ? -2 : -1);
    return wrong;
  }

  // Whatever value the caller's parameter may have must be one that the callee takes.
  void check_followed(const char* name, int argument, std::int32_t its, std::size_t followed) {
    const ScriptParameter& from = parameter(static_cast<std::int32_t>(followed));
    const int top = lua_gettop(state);
    bool wrong = false;
    if (argument != 0) {
      const char* of = lua_pushfstring(state, "behavior '%s'", called());
      wrong = push_followed_refusal(state, argument, from, name, of);
    } else {
      const ScriptParameter& own = parameter(its);
      wrong = !(from.min >= own.min && from.max <= own.max);
      if (wrong)
        lua_pushfstring(state, "parameter '%s', which '%s' follows, may be %f..%f, but '%s' of behavior '%s' is %f..%f",
                        from.name.c_str(), name, from.min, from.max, name, called(), own.min, own.max);
    }
    if (wrong) raise_at(state, place, name, "%s", lua_tostring(state, -1));
    lua_settop(state, top);
  }

  void refuse_name(const char* name) {
    const std::string& chunk = chart.states[machine().root].chunk;
    const Hint hint = make_hint(state, name, [&](auto& names) {
      for (const ScriptParameter& one : core_of(state).parameters) {
        if (one.chunk == chunk) names.push_back(one.name);
      }
      for (lua_pushnil(state); lua_next(state, declared) != 0; lua_pop(state, 1))
        names.emplace_back(lua_tostring(state, -2));
    });
    raise_at(state, place, name, "behavior '%s' takes no argument '%s'%s", called(), name, hint.data());
  }
};

// Which of the machine's values is this parameter's; nullptr: none.
const Chart::Given* given_to(const Chart::Machine& machine, std::size_t parameter) noexcept {
  for (const Chart::Given& one : machine.calls_with) {
    if (one.parameter == static_cast<std::int32_t>(parameter)) return &one;
  }
  return nullptr;
}

std::uint16_t caller_of(const Chart& chart, std::uint16_t machine) noexcept {
  return chart.states[chart.states[chart.machines[machine].root].parent].machine;
}

}  // namespace

void read_given(lua_State* state, Chart& chart, std::size_t machine, int given, const ScriptPlace& place) {
  luaL_checkstack(state, 12, "k.call");
  const int top = lua_gettop(state);
  Chart::Machine& called = chart.machines[machine];
  called.call_chunk = place.chunk;
  called.call_line = place.line;
  lua_newtable(state);
  if (called.arguments == Chart::no_function) {
    lua_newtable(state);
  } else {
    lua_rawgeti(state, LUA_REGISTRYINDEX, called.arguments);
  }
  CallReader reader{state, chart, machine, place, top + 2, top + 1};
  charge_table(state, given);
  for (lua_pushnil(state); lua_next(state, given) != 0; lua_pop(state, 1)) reader.read();
  lua_settop(state, top + 1);
  std::ranges::sort(chart.machines[machine].calls_with, {}, &Chart::Given::name);  // functions run in this order
  chart.machines[machine].given = luaL_ref(state, LUA_REGISTRYINDEX);
}

double parameter_value(lua_State* state, std::size_t number, std::uint16_t machine, std::size_t* looked) noexcept {
  const LuaCore& core = core_of(state);
  const auto* bindings = static_cast<const Bindings*>(core.bindings);
  const Chart& chart = bindings->runner->chart();
  for (;;) {
    const Chart::Machine& at = chart.machines[machine];
    const Chart::Given* given = given_to(at, number);
    if (looked != nullptr) *looked += at.calls_with.size();
    if (given == nullptr) return core.parameters[number].value;
    if (given->follows == Chart::no_parameter)
      return given->function == Chart::no_function
                 ? given->value
                 : bindings->evaluated[machine][static_cast<std::size_t>(given - at.calls_with.data())];
    number = static_cast<std::size_t>(given->follows);
    machine = caller_of(chart, machine);
  }
}

double charged_value(lua_State* state, std::size_t number, std::uint16_t machine) {
  std::size_t looked = 0;
  const double value = parameter_value(state, number, machine, &looked);
  if (looked > 0) core_of(state).budget.charge(state, given_instructions * static_cast<double>(looked));
  return value;
}

double value_here(lua_State* state, std::size_t number) {
  const auto* bindings = static_cast<const Bindings*>(core_of(state).bindings);
  if (bindings == nullptr || bindings->runner == nullptr) return core_of(state).parameters[number].value;
  return charged_value(state, number, bindings->runner->acting().machine);
}

void make_room_for_calls(const LuaCore& core, const Chart& chart, Bindings& bindings) {
  bindings.evaluated.clear();
  for (const Chart::Machine& machine : chart.machines) {
    std::vector<double>& values = bindings.evaluated.emplace_back();
    for (const Chart::Given& given : machine.calls_with)
      values.push_back(given.parameter == Chart::no_parameter
                           ? 0.0
                           : core.parameters[static_cast<std::size_t>(given.parameter)].value);
  }
}

bool push_given_refusal(lua_State* state, const Chart::Machine& machine, const Chart::Given& given) {
  const int value = lua_gettop(state);
  if (given.parameter != Chart::no_parameter) {
    return push_refused_value(state, core_of(state).parameters[static_cast<std::size_t>(given.parameter)],
                              machine.name.c_str());
  }
  lua_rawgeti(state, LUA_REGISTRYINDEX, machine.arguments);
  lua_getfield(state, -1, given.name.c_str());
  const char* of = lua_pushfstring(state, "behavior '%s'", machine.name.c_str());
  if (!push_refusal(state, value + 2, value, given.name.c_str(), of)) return lua_settop(state, value), false;
  lua_replace(state, value + 1);
  lua_settop(state, value + 1);
  return true;
}

// The value at the top of the stack, which is as declared. [-1 +0]
void ChartRunner::give(lua_State* state, std::uint16_t machine, std::size_t number) {
  const Chart::Given& given = chart_.machines[machine].calls_with[number];
  if (given.parameter != Chart::no_parameter) {
    bindings_of(state).evaluated[machine][number] = lua_tonumber(state, -1);
    return lua_pop(state, 1);
  }
  push_entry(state, tables_.machines[machine].content, "args");
  push_plain_copy(state, lua_gettop(state) - 1);
  lua_setfield(state, -2, given.name.c_str());
  lua_pop(state, 2);
}

bool ChartRunner::evaluate_call(lua_State* state, std::uint16_t number) {
  const Chart::Machine& machine = chart_.machines[number];
  const StateIndex caller = chart_.states[machine.root].parent;
  for (std::size_t i = 0; i < machine.calls_with.size(); ++i) {
    const Chart::Given& given = machine.calls_with[i];
    if (given.function == Chart::no_function && given.parameter != Chart::no_parameter) continue;
    const int top = lua_gettop(state);
    if (given.function != Chart::no_function) {
      push_call(state, given.function, caller);
      if (!call_recoverably(state, caller, 2, 1)) return false;
    } else {
      lua_pushnumber(state,
                     charged_value(state, static_cast<std::size_t>(given.follows), chart_.states[caller].machine));
    }
    if (push_given_refusal(state, machine, given)) {
      lua_pushfstring(state, "%s:%d: %s", machine.call_chunk.c_str(), given.line, lua_tostring(state, -1));
      fail(state, caller);
      return lua_settop(state, top), false;
    }
    give(state, number, i);
    lua_settop(state, top);
  }
  return true;
}

void ChartRunner::push_arguments(lua_State* state) const {
  push_entry(state, tables_.machines[chart_.states[acting_].machine].content, "args");
}

}  // namespace kadans
