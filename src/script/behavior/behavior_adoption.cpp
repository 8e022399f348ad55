// From one version of a behavior to the next: what it carries over.
#include "behavior_parts.h"
#include "script/lua/lua_core.h"
#include "vars_transfer.h"

namespace kadans {
namespace {

struct Adoption {
  Behavior::Parts& fresh;
  Behavior::Parts& old;
  const std::vector<StateIndex>& map;
};

// Only what somebody changed while it ran, if the new version still takes it.
void carry_parameters(Behavior::Parts& fresh, Behavior::Parts& old) noexcept {
  for (const ScriptParameter& was : old.lua->core().parameters) {
    if (was.value == was.initial) continue;
    for (ScriptParameter& is : fresh.lua->core().parameters) {
      if (is.name == was.name && was.value >= is.min && was.value <= is.max) is.value = was.value;
    }
  }
}

// The machine's fresh vars are at the top of `state`, those it had behind them: [-1].
void overlay(lua_State* state) {
  const int old = lua_gettop(state), vars = old - 1;
  for (lua_pushnil(state); lua_next(state, old) != 0;) {
    lua_pushvalue(state, -2);
    lua_insert(state, -2);
    lua_rawset(state, vars);
  }
  lua_settop(state, vars);
}

void carry_vars(lua_State* state, const Adoption& adoption, std::size_t from, std::uint16_t to) {
  Behavior::Parts& fresh = adoption.fresh;
  const Chart::Machine& was = adoption.old.chart.machines[from];
  if (!takes_vars(fresh.chart.machines[to], was.version)) return;
  lua_State* old_state = adoption.old.lua->get();
  luaL_checkstack(state, 16, "vars");
  push_vars(state, fresh.tables.machines[to]);
  push_vars(old_state, adoption.old.tables.machines[from]);
  push_copy_across(old_state, lua_gettop(old_state), state);
  give_vars(state, fresh.chart.machines[to], was.version);
  lua_settop(state, 1);
}

void renew_machines(lua_State* state, const Adoption& adoption) {
  Behavior::Parts& fresh = adoption.fresh;
  const Chart& chart = adoption.old.chart;
  for (std::size_t i = 0; i < chart.machines.size(); ++i) {
    const StateIndex root = chart.machines[i].root, to = adoption.map[root];
    if (to == no_state || !adoption.old.runner->active(root)) continue;
    const std::uint16_t machine = fresh.chart.states[to].machine;
    renew_machine(state, fresh.chart, fresh.tables, machine);
    carry_vars(state, adoption, i, machine);
  }
}

// Twice: the guards are tried on vars that are thrown away, since they may write, which they should not.
int adopt(lua_State* state) {
  const Adoption& adoption = *static_cast<const Adoption*>(lua_touserdata(state, 1));
  Behavior::Parts& fresh = adoption.fresh;
  const RandomStream random = adoption.old.lua->core().random;
  fresh.snapshot_tables.refill(state, *fresh.bindings.snapshot, fresh.bindings.now_ns);
  renew_machines(state, adoption);
  fresh.runner->take_over(state, *adoption.old.runner, adoption.map);
  fresh.lua->core().random = random;
  fresh.runner->try_guards(state);
  renew_machines(state, adoption);
  fresh.lua->core().random = random;
  return 0;
}

struct Leaving {
  Behavior::Parts& parts;
  const std::vector<bool>& marks;
};

int leave(lua_State* state) {
  const Leaving& leaving = *static_cast<const Leaving*>(lua_touserdata(state, 1));
  Behavior::Parts& parts = leaving.parts;
  parts.snapshot_tables.refill(state, *parts.bindings.snapshot, parts.bindings.now_ns);
  parts.runner->leave_marked(state, leaving.marks, parts.bindings.now_ns);
  return 0;
}

}  // namespace

void push_vars(lua_State* state, const RunnerTables::Machine& machine) {
  lua_rawgeti(state, LUA_REGISTRYINDEX, machine.content);
  lua_pushliteral(state, "vars");
  lua_rawget(state, -2);
  lua_remove(state, -2);
}

bool takes_vars(const Chart::Machine& machine, int version) noexcept {
  return machine.version == version || machine.migrate != Chart::no_function;
}

void give_vars(lua_State* state, const Chart::Machine& machine, int version) {
  if (machine.version != version) {
    core_of(state).called = machine.migrate;
    lua_rawgeti(state, LUA_REGISTRYINDEX, machine.migrate);
    lua_insert(state, -2);
    lua_pushinteger(state, version);
    lua_call(state, 2, 1);
    if (!lua_istable(state, -1)) luaL_error(state, "migrate must return the new vars, a table");
  }
  overlay(state);
}

bool adopt_behavior(Behavior::Parts& fresh, Behavior::Parts& old, const std::vector<StateIndex>& map,
                    const Snapshot& snapshot, CommandSender& commands) noexcept {
  carry_parameters(fresh, old);
  fresh.transactions_refused = old.transactions_refused;
  fresh.bindings.wanted = old.bindings.wanted & fresh.bindings.all_sets();
  fresh.bindings.sent = old.bindings.sent;
  fresh.bindings.sent_count = old.bindings.sent_count;
  fresh.bindings.refusals_seen = old.bindings.refusals_seen;
  if (!old.runner->started()) return true;
  Adoption adoption{fresh, old, map};
  fresh.bindings.begin(commands, snapshot, snapshot.time_ns);
  const int top = lua_gettop(old.lua->get());
  const ScriptLimits& limits = fresh.settings.limits;
  const bool adopted = fresh.lua->call(adopt, &adoption, limits.reload_instructions, limits.load_wall_ns);
  lua_settop(old.lua->get(), top);
  commands.discard();  // a guard that commands
  if (adopted) fresh.want_sets(snapshot);
  return adopted;
}

bool leave_states(Behavior::Parts& parts, const std::vector<bool>& marks, const Snapshot& snapshot,
                  CommandSender& commands) noexcept {
  Leaving leaving{parts, marks};
  parts.bindings.begin(commands, snapshot, snapshot.time_ns);
  const Behavior::Settings& settings = parts.settings;
  if (parts.lua->call(leave, &leaving, settings.limits.tick_instructions, settings.limits.tick_wall_ns)) {
    (void)parts.bindings.commit();
    return true;
  }
  commands.discard();
  return false;
}

}  // namespace kadans
