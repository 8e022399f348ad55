// m.<object>: a control object as a behavior sees it. Everything is checked before the first command is made.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "bindings.h"
#include "engine/behavior_inputs.h"
#include "machine_sets.h"
#include "script/check/hint.h"
#include "script/motion/motion_options.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

const HandleKey object_key = 0;
constexpr double command_instructions = 20;

// object:setpoint(name) -> number: where it is on its way now.
int setpoint(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  return lua_pushnumber(state, present_setpoint(state, read_setpoint(state, 2, object)).value), 1;
}

ParameterId read_parameter(lua_State* state, int index, const ObjectInfo& object) {
  const Catalog& catalog = *bindings_of(state).catalog;
  const char* name = luaL_checkstring(state, index);
  for (const ParameterId id : object.parameters) {
    if (std::strcmp(short_name(object, catalog.parameters.info(id).name), name) == 0) return id;
  }
  const Hint hint = make_hint(state, name, [&](auto& names) {
    for (const ParameterId id : object.parameters)
      names.emplace_back(short_name(object, catalog.parameters.info(id).name));
  });
  luaL_error(state, "'%s' has no parameter '%s'%s", object.name.c_str(), name, hint.data());
  return 0;
}

// object:parameter(name) -> number: what it was set to last.
int parameter(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  const ParameterId id = read_parameter(state, 2, object);
  const double newest = bindings_of(state).catalog->parameters.newest(id);
  BehaviorInputs* const inputs = core_of(state).limits.inputs_now();
  return lua_pushnumber(state, inputs == nullptr ? newest : inputs->parameter(newest)), 1;
}

// object:set_parameter(name, value) -> true | nil, "queue_full".
int set_parameter(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  Bindings& bindings = bindings_of(state);
  const ParameterId id = read_parameter(state, 2, object);
  const double value = luaL_checknumber(state, 3);
  const Parameter& info = bindings.catalog->parameters.info(id);
  check_range(state, info.name.c_str(), info.unit.c_str(), value, info.min, info.max);
  return tell_sent(state, bindings.send({.kind = CommandKind::set_parameter, .index = id, .value = value}));
}

// object:set_gains(preset) -> true | nil, "queue_full".
int set_gains(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  Bindings& bindings = bindings_of(state);
  const char* name = luaL_checkstring(state, 2);
  for (const Preset& preset : object.presets) {
    if (preset.name != name) continue;
    bool sent = true;
    for (const auto& [id, value] : preset.values)
      sent = sent && bindings.send({.kind = CommandKind::set_parameter, .index = id, .value = value});
    return tell_sent(state, sent);
  }
  const Hint hint = make_hint(state, name, [&](auto& names) { names = names_of(object.presets); });
  return luaL_error(state, "'%s' has no gains '%s'%s", object.name.c_str(), name, hint.data());
}

// object:hold() -> true | nil, "queue_full": all its motions come to rest where they are.
int hold(lua_State* state) {
  const ObjectInfo& object = check_object(state);
  core_of(state).budget.charge(state, command_instructions * static_cast<double>(object.setpoints.size()));
  bool sent = true;
  for (const SetpointId id : object.setpoints)
    sent = sent && bindings_of(state).send({.kind = CommandKind::cancel_motion, .index = id});
  return tell_sent(state, sent);
}

}  // namespace

const std::uint32_t* to_object(lua_State* state, int index) noexcept {
  return static_cast<const std::uint32_t*>(to_handle(state, index, object_key));
}

std::uint32_t object_number(const Catalog& catalog, const ObjectInfo& object) noexcept {
  return static_cast<std::uint32_t>(&object - catalog.objects.data());
}

const ObjectInfo& check_object(lua_State* state) {
  const std::uint32_t* handle = to_object(state, 1);
  if (handle == nullptr) luaL_error(state, "call it on a control object, with a colon: m.object:method(...)");
  const std::uint32_t number = handle != nullptr ? *handle : 0;
  const Bindings& bindings = bindings_of(state);
  if (bindings.runner != nullptr && !bindings.recording) {  // m:on may switch to the set of any object
    const Chart::State& acting = bindings.runner->acting();
    const bool there = acting.sets == 0 || (bindings.partition->objects(acting.sets) >> number & 1U) != 0;
    if (!there) luaL_error(state, "%s", not_in_sets(bindings, number, acting).data());
  }
  return bindings.catalog->objects[number];
}

const char* short_name(const ObjectInfo& object, const std::string& name) noexcept {
  return name.c_str() + std::min(name.size(), object.name.size() + 1);
}

void check_range(lua_State* state, const char* name, const char* unit, double value, double min, double max) {
  if (value >= min && value <= max) return;
  const auto degrees = degree_hint(unit, value, min, max);
  luaL_error(state, "%s = %f is outside its range %f..%f %s%s", name, value, min, max, unit, degrees.data());
}

int queue_full(lua_State* state) { return lua_pushnil(state), lua_pushliteral(state, "queue_full"), 2; }
int tell_sent(lua_State* state, bool sent) { return sent ? (lua_pushboolean(state, 1), 1) : queue_full(state); }

void push_object(lua_State* state, std::uint32_t object) {
  *static_cast<std::uint32_t*>(lua_newuserdata(state, sizeof object)) = object;
  set_kind(state, object_key);
}

namespace {

void open_objects(lua_State* state) {
  const luaL_Reg methods[] = {{"setpoint", setpoint},
                              {"parameter", parameter},
                              {"set_gains", set_gains},
                              {"set_parameter", set_parameter},
                              {"hold", hold}};
  lua_createtable(state, 0, 2);
  lua_createtable(state, 0, 8);
  set_functions(state, methods);
  open_motion_methods(state);
  make_read_only(state, "a control object");
  lua_setfield(state, -2, "__index");
  open_kind(state, object_key);
}

// `m`: what the functions of a behavior act through. Each machine has its own; the control objects are the same.

constexpr double copied_field_instructions = 20;

// m:wait(seconds): inside `run` only.
int wait(lua_State* state) {
  const double seconds = luaL_checknumber(state, 2);
  if (!(seconds >= 0 && seconds < 1e6)) return luaL_error(state, "m:wait takes seconds >= 0, below 1e6");
  if (core_of(state).running != state) return luaL_error(state, "m:wait() works inside `run` only");
  ChartRunner& runner = *bindings_of(state).runner;
  runner.wait_until(runner.now_ns() + static_cast<std::int64_t>(std::llround(seconds * 1e9)));
  lua_settop(state, 0);
  return lua_yield(state, 0);
}

// Reading what m does not have; upvalues: its content, its number.
int refuse_read(lua_State* state) {
  const Bindings& bindings = bindings_of(state);
  const auto number = static_cast<std::size_t>(lua_tointeger(state, lua_upvalueindex(2)));
  for (std::uint32_t i = 0; i < bindings.catalog->objects.size(); ++i) {
    const ObjectInfo& object = bindings.catalog->objects[i];
    if (lua_type(state, 2) != LUA_TSTRING || object.name != lua_tostring(state, 2)) continue;
    if (bindings.folders != nullptr)
      return luaL_error(state, "'%s' is a control object: a k.decisions has none, it plays behaviors that have",
                        object.name.c_str());
    if (bindings.recording) return push_object(state, i), 1;  // m:on may switch to its set
    if (number < bindings.machine_sets.size())
      return luaL_error(state, "%s", not_in_sets(bindings, object.name, number).data());
  }
  return raise_unknown_field(state, "m", lua_upvalueindex(1), 2);
}

// m:clear_faults() -> true | nil, "queue_full". What is asked for behind it in the same tick counts already.
int clear_faults(lua_State* state) {
  if (bindings_of(state).recording) return luaL_error(state, "what waits for a condition cannot clear faults");
  return tell_sent(state, bindings_of(state).send({.kind = CommandKind::clear_faults}));
}

// m:reset_odometry() -> true | nil, "queue_full". Raises where the robot has no feet.
int reset_odometry(lua_State* state) {
  Bindings& bindings = bindings_of(state);
  if (bindings.recording) return luaL_error(state, "what waits for a condition cannot reset the odometry");
  if (bindings.catalog->feet.empty()) return luaL_error(state, "the robot has no feet, so it has no odometry");
  return tell_sent(state, bindings.send({.kind = CommandKind::reset_odometry}));
}

// [-0 +1] A deep copy of the value at `index`: plain data only.
void push_copy(lua_State* state, int index, int depth) {
  const int type = lua_type(state, index);
  if (type == LUA_TFUNCTION || type == LUA_TUSERDATA || type == LUA_TTHREAD) {
    luaL_error(state, "vars and args hold plain data, not a %s", luaL_typename(state, index));
  }
  if (type != LUA_TTABLE) return lua_pushvalue(state, index);
  if (depth > vars_depth_max) luaL_error(state, "vars and args are nested too deeply");
  luaL_checkstack(state, 6, "vars and args are nested too deeply");
  Budget& budget = core_of(state).budget;
  charge_table(state, index);
  lua_newtable(state);
  const int copy = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, index) != 0;) {
    budget.charge(state, copied_field_instructions);
    lua_pushvalue(state, -2);
    push_copy(state, lua_gettop(state) - 1, depth + 1);
    lua_rawset(state, copy);
    lua_pop(state, 1);
  }
}

// [-0 +1] What a behavior's args hold when a call gives nothing: name = default.
void push_defaults(lua_State* state, int declared) {
  lua_newtable(state);
  const int made = lua_gettop(state);
  if (declared == Chart::no_function) return;
  lua_rawgeti(state, LUA_REGISTRYINDEX, declared);
  for (lua_pushnil(state); lua_next(state, made + 1) != 0;) {
    lua_rawgeti(state, -1, 1);
    lua_replace(state, -2);
    lua_pushvalue(state, -2);
    push_copy(state, lua_gettop(state) - 1, 0);
    lua_rawset(state, made);
    lua_pop(state, 1);
  }
  lua_pop(state, 1);
}

void push_copy_of_reference(lua_State* state, int reference) {
  if (reference == Chart::no_function) return lua_newtable(state);
  lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
  push_copy(state, lua_gettop(state), 0);
  lua_remove(state, -2);
}

// [-0 +1] A copy of the data of an event, the table at `index`: plain data, bounded.
void push_event_data(lua_State* state, int index, int depth, int& fields) {
  constexpr int fields_max = 64, depth_max = 4;
  constexpr std::size_t text_max = 256;
  luaL_checkstack(state, 6, "event data");
  lua_newtable(state);
  const int copy = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    core_of(state).budget.charge(state, copied_field_instructions);
    if (++fields > fields_max) luaL_error(state, "an event's data has more than %d fields", fields_max);
    const int value = lua_gettop(state), type = lua_type(state, value);
    for (const int at : {value - 1, value}) {
      if (lua_type(state, at) == LUA_TSTRING && lua_objlen(state, at) > text_max)
        luaL_error(state, "a text in an event's data is longer than %d characters", static_cast<int>(text_max));
    }
    const bool plain = type == LUA_TNUMBER || type == LUA_TSTRING || type == LUA_TBOOLEAN || type == LUA_TTABLE;
    const int key = lua_type(state, value - 1);
    if (!plain || (key != LUA_TSTRING && key != LUA_TNUMBER))
      luaL_error(state, "an event's data is plain data, not a %s", luaL_typename(state, plain ? value - 1 : value));
    lua_pushvalue(state, value - 1);
    if (type == LUA_TTABLE) {
      if (depth == depth_max) luaL_error(state, "an event's data is nested too deeply");
      push_event_data(state, value, depth + 1, fields);
    } else {
      lua_pushvalue(state, value);
    }
    lua_rawset(state, copy);
  }
}

// m:emit(event, data?, { to = }?) -> true | nil, "queue_full". It is taken in this tick; from `during` and `run` in the
// next. With `to` it goes to other behaviors, which get it in their next tick.
int emit(lua_State* state) {
  if (bindings_of(state).recording)
    return luaL_error(state, "the function of m:on only says what to send: give m:on event = \"name\" instead");
  auto& chart = *static_cast<Chart*>(lua_touserdata(state, lua_upvalueindex(1)));
  const char* name = luaL_checkstring(state, 2);
  const bool given = !lua_isnoneornil(state, 3);
  if (given && !lua_istable(state, 3)) {
    return luaL_error(state, "the data of an event is a table { name = value }, not a %s", luaL_typename(state, 3));
  }
  const ScriptEvent* declared = find_event(core_of(state).events, name);
  if (!lua_isnoneornil(state, 4)) return send_away(state, declared, name, 3, 4);
  const EventId event = check_event(state, chart, name);
  if (declared != nullptr) check_event_data(state, *declared, 3);
  ChartRunner& runner = *bindings_of(state).runner;
  const bool with_data = given || (declared != nullptr && !declared->fields.empty());
  int fields = 0;
  if (given) push_event_data(state, 3, 1, fields);
  if (with_data && !given) lua_newtable(state);
  return tell_sent(state, with_data ? runner.post_with_data(state, event) : runner.post(event));
}

// (function, m, s) -> what the function of a final state's `result` returns, copied.
int make_result(lua_State* state) {
  lua_settop(state, 3);
  lua_call(state, 2, 1);
  if (!lua_istable(state, 1))
    return luaL_error(state, "result returns a table { name = value }, not a %s", luaL_typename(state, 1));
  int fields = 0;
  push_event_data(state, 1, 1, fields);
  return 1;
}

void push_machine_content(lua_State* state, const Chart& chart, const Bindings& bindings, std::size_t number) {
  lua_newtable(state);
  for (std::uint32_t object = 0; object < bindings.catalog->objects.size() && !chart.decides; ++object) {
    if (!bindings.has_object(number, object)) continue;
    push_object(state, object);
    lua_setfield(state, -2, bindings.catalog->objects[object].name.c_str());
  }
  set_field(state, "name", chart.machines[number].name.c_str());
  set_field(state, "time_s", 0.0);
  lua_newtable(state);
  lua_setfield(state, -2, "vars");
  lua_newtable(state);
  lua_setfield(state, -2, "args");
  lua_pushcfunction(state, wait);
  lua_setfield(state, -2, "wait");
  lua_pushlightuserdata(state, const_cast<Chart*>(&chart));
  lua_pushcclosure(state, emit, 1);
  lua_setfield(state, -2, "emit");
  if (chart.decides) return open_decisions(state);
  const luaL_Reg orders[] = {{"clear_faults", clear_faults}, {"reset_odometry", reset_odometry}};
  set_functions(state, orders);
  open_armed(state, chart);
}

}  // namespace

void push_plain_copy(lua_State* state, int index) { push_copy(state, index, 0); }

void push_texts(lua_State* state, const std::vector<std::string>& texts) {
  lua_createtable(state, static_cast<int>(texts.size()), 0);
  for (std::size_t i = 0; i < texts.size(); ++i) {
    lua_pushlstring(state, texts[i].data(), texts[i].size());
    lua_rawseti(state, -2, static_cast<int>(i) + 1);
  }
}

void push_event_data(lua_State* state, const PlayedEvent& event) {
  lua_createtable(state, 0, static_cast<int>(event.data.size()));
  for (const PlayArgument& field : event.data) {
    if (const auto* number = std::get_if<double>(&field.value)) lua_pushnumber(state, *number);
    if (const auto* flag = std::get_if<bool>(&field.value)) lua_pushboolean(state, *flag ? 1 : 0);
    if (const auto* text = std::get_if<std::string>(&field.value)) lua_pushlstring(state, text->data(), text->size());
    lua_setfield(state, -2, field.name.c_str());
  }
}

EventId check_event(lua_State* state, Chart& chart, const char* name) {
  if (reserved_for_reports(name))
    luaL_error(state, "'%s' reports what happened to the behavior, it cannot be emitted: give the event another name",
               name);
  const EventId event = chart.find_or_learn(name);
  if (event == no_event) luaL_error(state, "nothing in this behavior waits for the event '%s'", name);
  if (Chart::is_pattern(name)) luaL_error(state, "'%s' stands for several events: emit one of them", name);
  if (chart.made_by_runner(event))
    luaL_error(state, "'%s' says how a state or a run ended, it cannot be emitted: give the event another name", name);
  return event;
}

void open_machines(lua_State* state, const Chart& chart, const Bindings& bindings, RunnerTables& tables) {
  open_objects(state);
  open_motions(state);
  open_armed_handles(state);
  tables.machines.resize(chart.machines.size());
  push_texts(state, chart.events);
  tables.event_names = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_createtable(state, EventQueue::places, 0);
  tables.event_data = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_newtable(state);
  tables.results = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_pushcfunction(state, make_result);
  tables.make_result = luaL_ref(state, LUA_REGISTRYINDEX);
  for (std::size_t i = 0; i < chart.machines.size(); ++i) {
    push_machine_content(state, chart, bindings, i);
    lua_pushvalue(state, -1);
    tables.machines[i].content = luaL_ref(state, LUA_REGISTRYINDEX);
    lua_createtable(state, 0, 1);
    lua_pushvalue(state, -2);
    lua_pushinteger(state, static_cast<lua_Integer>(i));
    lua_pushcclosure(state, refuse_read, 2);
    lua_setfield(state, -2, "__index");
    lua_setmetatable(state, -2);
    make_read_only(state, "m", false);
    tables.machines[i].handle = luaL_ref(state, LUA_REGISTRYINDEX);
  }
  lua_newtable(state);
  tables.threads = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_pushliteral(state, "time_s");
  tables.time_key = luaL_ref(state, LUA_REGISTRYINDEX);
}

void renew_machine(lua_State* state, const Chart& chart, const RunnerTables& tables, std::uint16_t number) {
  const Chart::Machine& machine = chart.machines[number];
  const int top = lua_gettop(state);
  lua_rawgeti(state, LUA_REGISTRYINDEX, tables.machines[number].content);
  push_copy_of_reference(state, machine.vars);
  lua_setfield(state, top + 1, "vars");
  push_defaults(state, machine.arguments);
  if (machine.given != Chart::no_function) {
    lua_rawgeti(state, LUA_REGISTRYINDEX, machine.given);
    for (lua_pushnil(state); lua_next(state, top + 3) != 0;) {
      lua_pushvalue(state, -2);
      push_copy(state, lua_gettop(state) - 1, 0);
      lua_rawset(state, top + 2);
      lua_pop(state, 1);
    }
    lua_pop(state, 1);
  }
  lua_setfield(state, top + 1, "args");
  lua_settop(state, top);
}

}  // namespace kadans
