// A behavior as bytes and back: what a reload carries from one Lua state to the next (behavior_reload.cpp), from one
// process to the next.

#include <cstring>
#include <exception>

#include "behavior_parts.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"
#include "signal/byte_order.h"

namespace kadans {
namespace {

static_assert(std::is_trivially_copyable_v<RandomStream>);

void put_parameters(const LuaCore& core, ByteWriter& bytes) {
  for (const ScriptParameter& parameter : core.parameters) {
    if (parameter.value == parameter.initial) continue;
    bytes.put<std::uint8_t>(1);
    bytes.put_string(parameter.name);
    bytes.put(parameter.value);
  }
  bytes.put<std::uint8_t>(0);
}

void take_parameters(LuaCore& core, ByteReader& bytes) {
  while (bytes.take<std::uint8_t>() != 0) {
    const std::string name = bytes.take_string();
    const auto value = bytes.take<double>();
    for (ScriptParameter& parameter : core.parameters) {
      if (parameter.name == name && value >= parameter.min && value <= parameter.max) parameter.value = value;
    }
  }
}

void put_bindings(const Bindings& bindings, ByteWriter& bytes) {
  bytes.put(bindings.wanted);
  for (const std::uint32_t sequence : bindings.sent) bytes.put(sequence);
  bytes.put(bindings.sent_count);
  bytes.put(bindings.refusals_seen);
}

void take_bindings(Bindings& bindings, ByteReader& bytes) {
  bindings.wanted = bytes.take<SetMask>() & bindings.all_sets();
  for (std::uint32_t& sequence : bindings.sent) sequence = bytes.take<std::uint32_t>();
  bindings.sent_count = bytes.take<std::uint32_t>();
  bindings.refusals_seen = bytes.take<std::uint32_t>();
}

// Of each machine that is active: where its root is, its version, its vars.
std::string put_machines(Behavior::Parts& parts, ByteWriter& bytes) {
  lua_State* state = parts.lua->get();
  std::string why;
  for (std::size_t i = 0; i < parts.chart.machines.size() && why.empty(); ++i) {
    const Chart::Machine& machine = parts.chart.machines[i];
    if (!parts.runner->active(machine.root)) continue;
    bytes.put<std::uint8_t>(1);
    bytes.put_string(parts.chart.states[machine.root].path);
    bytes.put(std::int32_t{machine.version});
    const int top = lua_gettop(state);
    if (lua_checkstack(state, 8) == 0) return "out of memory";
    push_vars(state, parts.tables.machines[i]);
    (void)put_value(state, top + 1, bytes, why);
    lua_settop(state, top);
  }
  bytes.put<std::uint8_t>(0);
  return why;
}

struct GoingOn {
  Behavior::Parts& parts;
  ByteReader& bytes;
};

std::size_t machine_at(const Chart& chart, std::string_view path) {
  std::size_t at = 0;
  while (at < chart.machines.size() && chart.states[chart.machines[at].root].path != path) ++at;
  return at;
}

void renew_active_machines(lua_State* state, Behavior::Parts& parts) {
  for (std::size_t i = 0; i < parts.chart.machines.size(); ++i) {
    if (!parts.runner->active(parts.chart.machines[i].root)) continue;
    renew_machine(state, parts.chart, parts.tables, static_cast<std::uint16_t>(i));
  }
}

int take_machines(lua_State* state) {
  const GoingOn& going_on = *static_cast<const GoingOn*>(lua_touserdata(state, 1));
  Behavior::Parts& parts = going_on.parts;
  ByteReader& bytes = going_on.bytes;
  parts.snapshot_tables.refill(state, *parts.bindings.snapshot, parts.bindings.now_ns);
  renew_active_machines(state, parts);
  while (bytes.take<std::uint8_t>() != 0) {
    const auto path = bytes.take_bytes(bytes.take<std::uint32_t>());
    const std::size_t number = machine_at(parts.chart, {reinterpret_cast<const char*>(path.data()), path.size()});
    const auto version = bytes.take<std::int32_t>();
    const bool known = number < parts.chart.machines.size() && parts.runner->active(parts.chart.machines[number].root);
    luaL_checkstack(state, 16, "vars");
    if (known) push_vars(state, parts.tables.machines[number]);
    push_value(state, bytes, parts.catalog);
    if (!lua_istable(state, -1)) luaL_error(state, "vars that are no table were kept");
    if (known && takes_vars(parts.chart.machines[number], version))
      give_vars(state, parts.chart.machines[number], version);
    lua_settop(state, 1);
  }
  parts.runner->be_at(parts.bindings.now_ns);
  parts.runner->start_runs(state);
  return 0;
}

constexpr std::size_t kept_bytes_max = std::size_t{256} << 10U;
enum Tag : std::uint8_t { tag_nil, tag_false, tag_true, tag_number, tag_string, tag_table, tag_end, tag_motion };

bool put_table(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth) {
  if (depth > vars_depth_max || lua_checkstack(state, 8) == 0) return why = "vars are nested too deeply", false;
  bytes.put<std::uint8_t>(tag_table);
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    if (bytes.size() > kept_bytes_max) return why = "vars hold too much", false;  // the same table twice counts twice
    const int value = lua_gettop(state);
    if (!put_value(state, value - 1, bytes, why, depth + 1) || !put_value(state, value, bytes, why, depth + 1))
      return false;
  }
  bytes.put<std::uint8_t>(tag_end);
  return true;
}

bool put_motion(lua_State* state, int index, ByteWriter& bytes, std::string& why) {
  Motion* motion = to_motion(state, index);
  if (motion == nullptr) return why = "vars hold a userdata", false;
  bytes.put<std::uint8_t>(tag_motion);
  bytes.put(std::as_bytes(std::span(motion, 1)));
  bytes.put(std::as_bytes(std::span(motion->setpoints(), motion->count)));
  return true;
}

void push_motion_of(lua_State* state, ByteReader& bytes, const Catalog& catalog) {
  Motion kept;
  const auto fixed = bytes.take_bytes(sizeof kept);
  if (!fixed.empty()) std::memcpy(static_cast<void*>(&kept), fixed.data(), sizeof kept);
  const auto setpoints = bytes.take_bytes(std::uint64_t{kept.count} * sizeof(SetpointId));
  if (!bytes.ok() || kept.state > MotionState::expired) luaL_error(state, "no motion was kept here");
  Motion* motion = push_motion(state, kept.count);
  std::memcpy(static_cast<void*>(motion), &kept, sizeof kept);
  std::memcpy(motion->setpoints(), setpoints.data(), setpoints.size());
  for (std::uint32_t i = 0; i < kept.count; ++i) {
    if (motion->setpoints()[i] >= catalog.setpoints.size()) luaL_error(state, "a motion of no set-point was kept");
  }
}

// Until the end of the table; a key that is no key raises.
void push_table(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth) {
  if (depth > vars_depth_max) luaL_error(state, "what was kept is nested too deeply");
  luaL_checkstack(state, 8, "what was kept is nested too deeply");
  lua_newtable(state);
  for (;;) {
    ByteReader ahead = bytes;
    if (ahead.take<std::uint8_t>() == tag_end && ahead.ok()) return static_cast<void>(bytes = ahead);
    push_value(state, bytes, catalog, depth + 1);
    push_value(state, bytes, catalog, depth + 1);
    const bool key = lua_type(state, -2) != LUA_TNIL &&
                     (lua_type(state, -2) != LUA_TNUMBER || lua_tonumber(state, -2) == lua_tonumber(state, -2));
    if (!key) luaL_error(state, "a table without a key was kept");
    lua_rawset(state, -3);
  }
}

}  // namespace

std::string Behavior::keep(ByteWriter& bytes) {
  Parts& parts = *parts_;
  bytes.put<std::uint8_t>(parts.failed);
  bytes.put(parts.transactions_refused);
  put_parameters(parts.lua->core(), bytes);
  bytes.put(std::as_bytes(std::span(&parts.lua->core().random, 1)));
  put_bindings(parts.bindings, bytes);
  parts.runner->keep(bytes);
  return put_machines(parts, bytes);
}

bool Behavior::go_on(ByteReader& bytes, const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& parts = *parts_;
  LuaCore& core = parts.lua->core();
  parts.failed = bytes.take<std::uint8_t>() != 0;
  parts.transactions_refused = bytes.take<std::uint64_t>();
  take_parameters(core, bytes);
  RandomStream random = core.random;
  const auto kept = bytes.take_bytes(sizeof random);
  if (!kept.empty()) std::memcpy(static_cast<void*>(&random), kept.data(), sizeof random);
  take_bindings(parts.bindings, bytes);
  if (!parts.runner->restore(bytes)) {
    parts.error.set_message("what was kept does not fit the chart");
    return false;
  }
  GoingOn going_on{parts, bytes};
  parts.bindings.begin(commands, snapshot, snapshot.time_ns);
  const ScriptLimits& limits = parts.settings.limits;
  const bool taken = parts.lua->call(take_machines, &going_on, limits.load_instructions, limits.load_wall_ns);
  commands.discard();
  core.random = random;
  if (taken && parts.runner->started()) parts.want_sets(snapshot);
  publish_status();
  if (!taken) parts.error = parts.lua->error();
  return taken && bytes.ok();
}

bool put_value(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth) {
  switch (lua_type(state, index)) {
    case LUA_TNIL:
      return bytes.put<std::uint8_t>(tag_nil), true;
    case LUA_TBOOLEAN:
      return bytes.put<std::uint8_t>(lua_toboolean(state, index) != 0 ? tag_true : tag_false), true;
    case LUA_TNUMBER:
      bytes.put<std::uint8_t>(tag_number);
      return bytes.put(lua_tonumber(state, index)), true;
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(state, index, &length);
      bytes.put<std::uint8_t>(tag_string);
      return bytes.put_string({text, length}), true;
    }
    case LUA_TTABLE:
      return put_table(state, index, bytes, why, depth);
    case LUA_TUSERDATA:
      return put_motion(state, index, bytes, why);
    default:
      return why = std::string("vars hold a ") + lua_typename(state, lua_type(state, index)), false;
  }
}

void push_value(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth) {
  const auto tag = bytes.take<std::uint8_t>();
  if (!bytes.ok()) luaL_error(state, "what was kept ends too early");
  switch (tag) {
    case tag_nil:
      return lua_pushnil(state);
    case tag_false:
    case tag_true:
      return lua_pushboolean(state, tag == tag_true ? 1 : 0);
    case tag_number:
      return lua_pushnumber(state, bytes.take<double>());
    case tag_string: {
      const auto text = bytes.take_bytes(bytes.take<std::uint32_t>());
      return lua_pushlstring(state, reinterpret_cast<const char*>(text.data()), text.size());
    }
    case tag_table:
      return push_table(state, bytes, catalog, depth);
    case tag_motion:
      return push_motion_of(state, bytes, catalog);
    default:
      luaL_error(state, "what was kept is no value");
  }
}

}  // namespace kadans
