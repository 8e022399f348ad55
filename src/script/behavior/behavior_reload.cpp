#include <cstring>
#include <exception>

#include "behavior_parts.h"
#include "kadans/signal/input_error.h"
#include "script/bindings/machine_sets.h"
#include "script/chart/chart_map.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

constexpr std::int64_t probation_ns = 1'000'000'000;

// Whether the files hold these texts; the first is looked for at `first`.
bool holds(const std::filesystem::path& first, const std::vector<LuaState::Source>& sources) {
  try {
    for (std::size_t i = 0; i < sources.size(); ++i) {
      if (read_input_file(i == 0 ? first : sources[i].path) != sources[i].text) return false;
    }
  } catch (const InputError&) {
    return false;
  }
  return !sources.empty() && first.parent_path() == sources.front().path.parent_path();
}

std::vector<bool> marks(const ChartRunner& runner, const std::vector<StateIndex>& map) {
  std::vector<bool> gone(map.size(), false);
  for (std::size_t i = 0; i < map.size(); ++i) {
    gone[i] = map[i] == no_state && runner.active(static_cast<StateIndex>(i));
  }
  return gone;
}

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

void push_motion_across(lua_State* from, int index, lua_State* to) {
  Motion* motion = to_motion(from, index);
  if (motion == nullptr) {
    luaL_error(to, "vars hold a userdata: a reload carries plain data and motions");
    return;  // it has raised
  }
  Motion* copy = push_motion(to, motion->count);
  std::memcpy(static_cast<void*>(copy), motion, sizeof(Motion) + motion->count * sizeof(SetpointId));
}

void push_table_across(lua_State* from, int index, lua_State* to, int depth) {
  if (depth > vars_depth_max) luaL_error(to, "vars are nested too deeply to be carried through a reload");
  if (lua_checkstack(from, 8) == 0) luaL_error(to, "vars cannot be read");
  luaL_checkstack(to, 8, "vars are nested too deeply");
  lua_newtable(to);
  for (lua_pushnil(from); lua_next(from, index) != 0; lua_pop(from, 1)) {
    const int value = lua_gettop(from);
    push_copy_across(from, value - 1, to, depth + 1);
    push_copy_across(from, value, to, depth + 1);
    lua_rawset(to, -3);
  }
}

}  // namespace

std::vector<std::filesystem::path> Behavior::files() const {
  std::vector<std::filesystem::path> all;
  for (const LuaState::Source& source : parts_->lua->sources()) all.push_back(source.path);
  return all;
}

Behavior::Reload Behavior::refuse(std::int64_t time_ns, const std::string& why) noexcept {
  if (why == past_->complaint) return Reload::refused;
  past_->complaint = why;
  parts_->log.message(time_ns, BehaviorLog::Severity::warning, name(),
                      "reload refused, the old version goes on: " + why);
  return Reload::refused;
}

Behavior::Reload Behavior::reload(const Snapshot& snapshot, CommandSender& commands, const std::filesystem::path& file,
                                  SetMask elsewhere) noexcept {
  const std::filesystem::path wanted = file.empty() ? parts_->settings.file : file;
  if (failed() || finished() || holds(wanted, parts_->lua->sources())) return Reload::unchanged;
  if (file.empty() && holds(wanted, past_->taken_back)) return Reload::unchanged;
  Settings settings = parts_->settings;
  settings.file = wanted;
  std::unique_ptr<Parts> fresh;
  try {
    fresh = std::make_unique<Parts>(settings, parts_->catalog, parts_->log);
    fresh->bindings.held_ns = parts_->bindings.held_ns;
    fresh->bindings.now_ns = clock_ns(snapshot);
    load_behavior(*fresh, settings.limits.reload_instructions);
  } catch (const std::exception& error) {
    return refuse(snapshot.time_ns, error.what());
  }
  if (!holds(wanted, fresh->lua->sources())) return refuse(snapshot.time_ns, "the file changed while it was read");
  if (const std::string clash = clash_text(fresh->catalog, fresh->bindings.all_sets(), elsewhere); !clash.empty()) {
    return refuse(snapshot.time_ns, clash + ", and the other set's behavior plays at the same time");
  }
  if (!adopt_behavior(*fresh, *parts_, map_states(parts_->chart, fresh->chart), snapshot, commands)) {
    return refuse(snapshot.time_ns, fresh->lua->error().text());
  }
  swap(std::move(fresh), snapshot, commands);
  return Reload::taken;
}

void Behavior::swap(std::unique_ptr<Parts> fresh, const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& old = *parts_;
  past_->complaint.clear();
  if (old.runner->started()) {
    const std::vector<StateIndex> map = map_states(old.chart, fresh->chart);
    fresh->runner->report_gone(*old.runner, map);
    past_->left = marks(*old.runner, map);
    if (!leave_states(old, past_->left, snapshot, commands)) {
      old.log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "a state that is gone could not be left: " + old.lua->error().text());
    }
    past_->swapped_ns = clock_ns(snapshot);
    past_->parts = std::move(parts_);
  }
  parts_ = std::move(fresh);
  status_.reloads.fetch_add(1, std::memory_order_relaxed);
  parts_->log.message(snapshot.time_ns, BehaviorLog::Severity::info, name(),
                      "reloaded " + parts_->lua->sources().front().chunk);
}

bool Behavior::take_back(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (past_->parts == nullptr || clock_ns(snapshot) - past_->swapped_ns >= probation_ns) return false;
  Parts& failing = *parts_;
  Parts& old = *past_->parts;
  const ScriptError error = failing.lua->error();
  past_->taken_back = failing.lua->sources();
  if (error.breach == ScriptBreach::none) {  // what the new version entered itself
    std::vector<StateIndex> map = map_states(failing.chart, old.chart);
    for (StateIndex& index : map) index = index != no_state && old.runner->active(index) ? index : no_state;
    (void)leave_states(failing, marks(*failing.runner, map), snapshot, commands);
  }
  old.runner->enter_again(past_->left);
  old.want_sets(snapshot);
  parts_ = std::move(past_->parts);
  parts_->log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "new version taken back, the old one goes on: " + error.text());
  return true;
}

void Behavior::forget_past(std::int64_t now_ns) noexcept {
  if (past_->parts != nullptr && now_ns - past_->swapped_ns >= probation_ns) past_->parts.reset();
}

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

void push_copy_across(lua_State* from, int index, lua_State* to, int depth) {
  switch (lua_type(from, index)) {
    case LUA_TNIL:
      return lua_pushnil(to);
    case LUA_TBOOLEAN:
      return lua_pushboolean(to, lua_toboolean(from, index));
    case LUA_TNUMBER:
      return lua_pushnumber(to, lua_tonumber(from, index));
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(from, index, &length);
      return lua_pushlstring(to, text, length);
    }
    case LUA_TTABLE:
      return push_table_across(from, index, to, depth);
    case LUA_TUSERDATA:
      return push_motion_across(from, index, to);
    default:
      luaL_error(to, "vars hold a %s: a reload carries plain data and motions", luaL_typename(from, index));
  }
}

}  // namespace kadans
