// A behavior as bytes and back: what a reload carries from one Lua state to the next (behavior_adoption.cpp), from one
// process to the next.
#include <cstring>
#include <exception>

#include "behavior_parts.h"
#include "script/lua/lua_core.h"
#include "signal/byte_order.h"
#include "vars_keeping.h"

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

}  // namespace kadans
