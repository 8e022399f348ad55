// A behavior as bytes and back: what is carried from one Lua state to the next when a file is reloaded or a process is
// replaced.
#include <cstring>
#include <exception>

#include "behavior_parts.h"
#include "kadans/signal/input_error.h"
#include "script/bindings/machine_sets.h"
#include "script/chart/chart_calls.h"
#include "script/lua/lua_core.h"
#include "script/motion/motion.h"
#include "signal/byte_order.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

static_assert(std::is_trivially_copyable_v<RandomStream>);

// Those that were set since the behavior was loaded. Files that it calls may have parameters of the same names.
void put_parameters(const Behavior::Parts& parts, ByteWriter& bytes) {
  for (const ScriptParameter& parameter : parts.lua->core().parameters) {
    if (parameter.value == parameter.loaded) continue;
    bytes.put<std::uint8_t>(1);
    bytes.put_string(first_name(parts, parameter.chunk));
    bytes.put_string(parameter.name);
    bytes.put(parameter.value);
  }
  bytes.put<std::uint8_t>(0);
}

void take_parameters(Behavior::Parts& parts, ByteReader& bytes) {
  while (bytes.take<std::uint8_t>() != 0) {
    const std::string chunk = bytes.take_string(), name = bytes.take_string();
    const auto value = bytes.take<double>();
    for (ScriptParameter& parameter : parts.lua->core().parameters) {
      const bool is_it = parameter.name == name && first_name(parts, parameter.chunk) == chunk;
      if (is_it && value >= parameter.min && value <= parameter.max) parameter.value = value;
    }
  }
}

void put_sent(const SentSoFar& bindings, ByteWriter& bytes) {
  bytes.put(bindings.sets_sent);
  bytes.put<std::uint8_t>(bindings.sets_lost);
  for (const std::uint32_t sequence : bindings.sent) bytes.put(sequence);
  bytes.put(bindings.sent_count);
  bytes.put(bindings.refusals_seen);
  bytes.put(bindings.refused_last);
  bytes.put(bindings.switched);
  bytes.put<std::uint8_t>(bindings.begun);
}

// What is armed, with the path of the state that it belongs to.
void put_armed(const Behavior::Parts& parts, ByteWriter& bytes) {
  const Bindings& bindings = parts.bindings;
  bytes.put(bindings.armed_count);
  for (std::uint32_t i = 0; i < bindings.armed_count; ++i) {
    const ArmedHere& armed = bindings.armed[i];
    bytes.put(armed.sequence);
    bytes.put(armed.which);
    bytes.put(armed.fired);
    bytes.put_string(armed.owner == no_state ? "" : parts.chart.states[armed.owner].path);
    bytes.put_string(armed.event == no_event ? "" : parts.chart.events[static_cast<std::size_t>(armed.event)]);
  }
}

// Without the state, or when it is not active, the next tick takes it back.
void take_armed(Behavior::Parts& parts, ByteReader& bytes) {
  Bindings& bindings = parts.bindings;
  for (auto left = bytes.take<std::uint32_t>(); left > 0 && bytes.ok(); --left) {
    ArmedHere armed{.sequence = bytes.take<std::uint32_t>(), .which = bytes.take<std::uint16_t>()};
    armed.fired = bytes.take<std::uint32_t>();
    const auto owner = std::ranges::find(parts.chart.states, bytes.take_string(), &Chart::State::path);
    if (owner != parts.chart.states.end()) armed.owner = static_cast<StateIndex>(owner - parts.chart.states.begin());
    armed.event = parts.chart.find_or_learn(bytes.take_string());
    if (armed.event != no_event && parts.chart.made_by_runner(armed.event)) armed.event = no_event;
    if (bytes.ok() && bindings.armed_count < bindings.armed.size()) bindings.armed[bindings.armed_count++] = armed;
  }
}

void take_sent(SentSoFar& bindings, ByteReader& bytes) {
  bindings.sets_sent = bytes.take<SetMask>();
  bindings.sets_lost = bytes.take<std::uint8_t>() != 0;
  for (std::uint32_t& sequence : bindings.sent) sequence = bytes.take<std::uint32_t>();
  bindings.sent_count = bytes.take<std::uint32_t>();
  bindings.refusals_seen = bytes.take<std::uint32_t>();
  bindings.refused_last = bytes.take<std::uint32_t>();
  bindings.switched = bytes.take<std::uint32_t>();
  bindings.begun = bytes.take<std::uint8_t>() != 0;
}

constexpr std::size_t kept_bytes_max = std::size_t{256} << 10U;
constexpr std::uint32_t unkept = UINT32_MAX;  // in place of the size of vars: the reason follows
enum Tag : std::uint8_t { tag_nil, tag_false, tag_true, tag_number, tag_string, tag_table, tag_end, tag_motion };

// [-0 +0] Appends the value at `index` (> 0): plain data and handles of motions. False: it contains something else, and
// `why` says what; then the stack may hold more than before. Never raises.
bool put_value(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth = 0);

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

// Of each machine that is active: where its root is, its version, its vars, or why they cannot be kept. Whether that
// matters is up to the version that goes on with them.
std::string put_machines(Behavior::Parts& parts, ByteWriter& bytes) {
  lua_State* state = parts.lua->get();
  std::string first;
  for (std::size_t i = 0; i < parts.chart.machines.size(); ++i) {
    const Chart::Machine& machine = parts.chart.machines[i];
    if (!parts.runner->active(machine.root)) continue;
    bytes.put<std::uint8_t>(1);
    bytes.put_string(parts.chart.states[machine.root].path);
    bytes.put(std::int32_t{machine.version});
    std::string why;
    const std::size_t at = bytes.size();
    bytes.put(std::uint32_t{0});
    const int top = lua_gettop(state);
    if (lua_checkstack(state, 8) == 0) why = "vars cannot be read";
    if (why.empty()) push_entry(state, parts.tables.machines[i].content, "vars");
    if (why.empty()) (void)put_value(state, top + 1, bytes, why);
    lua_settop(state, top);
    bytes.set(at, static_cast<std::uint32_t>(bytes.size() - at - sizeof(std::uint32_t)));
    if (!why.empty()) {
      bytes.shrink(at);
      bytes.put(unkept);
      bytes.put_string(why);
    }
    if (first.empty()) first = why;
  }
  bytes.put<std::uint8_t>(0);
  return first;
}

// [-0 +1] Pushes the next value of the bytes. Raises when there is none.
void push_value(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth = 0);

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

// True when a machine can take over vars of this version of it.
bool takes_vars(const Chart::Machine& machine, int version) noexcept {
  return machine.version == version || machine.migrate != Chart::no_function;
}

// [-1 +0] The top of the stack holds the vars that the machine had in `version`, below them are its own vars. Copies
// the old values into the own vars. Raises what `migrate` raises.
void give_vars(lua_State* state, const Chart::Machine& machine, int version) {
  if (machine.version != version) {
    core_of(state).called = machine.migrate;
    lua_rawgeti(state, LUA_REGISTRYINDEX, machine.migrate);
    lua_insert(state, -2);
    lua_pushinteger(state, version);
    lua_call(state, 2, 1);
    if (!lua_istable(state, -1)) luaL_error(state, "migrate must return the new vars, a table");
  }
  const int old = lua_gettop(state), vars = old - 1;
  for (lua_pushnil(state); lua_next(state, old) != 0;) {
    lua_pushvalue(state, -2);
    lua_insert(state, -2);
    lua_rawset(state, vars);
  }
  lua_settop(state, vars);
}

// The data of the events that wait, each behind a 1 and its place.
void put_event_data(Behavior::Parts& parts, ByteWriter& bytes) {
  lua_State* state = parts.lua->get();
  const EventQueue& events = parts.runner->events();
  const int top = lua_gettop(state);
  std::string why;
  for (std::size_t i = 0; i < events.size() && lua_checkstack(state, 8) != 0; ++i) {
    if (events[i].place < 0) continue;
    bytes.put<std::uint8_t>(1);
    bytes.put(events[i].place);
    push_entry(state, parts.tables.event_data, events[i].place + 1);
    ByteWriter value;
    if (put_value(state, top + 1, value, why))
      bytes.put(value.bytes());
    else
      bytes.put<std::uint8_t>(tag_nil);  // m:emit checked it; a script that got hold of it has changed it
    lua_settop(state, top);
  }
  bytes.put<std::uint8_t>(0);
}

void take_event_data(lua_State* state, const Behavior::Parts& parts, ByteReader& bytes) {
  luaL_checkstack(state, 8, "events");
  while (bytes.take<std::uint8_t>() != 0) {
    const auto place = bytes.take<std::int8_t>();
    push_value(state, bytes, parts.catalog);
    if (place < 0 || place >= EventQueue::places) luaL_error(state, "an event's data has no place");
    set_entry(state, parts.tables.event_data, place + 1);
  }
}

// The results of final states that are active: the end of a parallel may need them later.
void put_results(Behavior::Parts& parts, ByteWriter& bytes) {
  lua_State* state = parts.lua->get();
  const int top = lua_gettop(state);
  std::string why;
  for (StateIndex i = 0; i < parts.chart.size() && lua_checkstack(state, 8) != 0; ++i) {
    if (!parts.runner->active(i) || parts.chart.states[i].result == Chart::no_function) continue;
    push_entry(state, parts.tables.results, i + 1);
    ByteWriter value;
    if (put_value(state, top + 1, value, why)) {  // a script that got hold of it may have changed it
      bytes.put<std::uint8_t>(1);
      bytes.put_string(parts.chart.states[i].path);
      bytes.put(value.bytes());
    }
    lua_settop(state, top);
  }
  bytes.put<std::uint8_t>(0);
}

void take_results(lua_State* state, const Behavior::Parts& parts, ByteReader& bytes) {
  luaL_checkstack(state, 8, "results");
  while (bytes.take<std::uint8_t>() != 0) {
    const auto found = std::ranges::find(parts.chart.states, bytes.take_text(), &Chart::State::path);
    push_value(state, bytes, parts.catalog);
    const auto index = static_cast<int>(found - parts.chart.states.begin());
    if (found != parts.chart.states.end() && lua_istable(state, -1)) set_entry(state, parts.tables.results, index + 1);
    lua_settop(state, 1);
  }
}

// What calls have given by now, but for constants: those are in the text. Each value behind a 1, the path of the
// machine's root, and its name.
void put_given(Behavior::Parts& parts, ByteWriter& bytes) {
  lua_State* state = parts.lua->get();
  const int top = lua_gettop(state);
  std::string why;
  for (std::size_t i = 0; i < parts.chart.machines.size() && lua_checkstack(state, 8) != 0; ++i) {
    const Chart::Machine& machine = parts.chart.machines[i];
    if (!parts.runner->active(machine.root)) continue;
    for (std::size_t at = 0; at < machine.calls_with.size(); ++at) {
      const Chart::Given& given = machine.calls_with[at];
      const bool argument = given.parameter == Chart::no_parameter;
      if (!argument && given.function == Chart::no_function) continue;
      lua_pushnumber(state, parts.bindings.evaluated[i][at]);
      if (argument) {
        push_entry(state, parts.tables.machines[i].content, "args");
        lua_getfield(state, -1, given.name.c_str());
      }
      ByteWriter value;
      if (put_value(state, lua_gettop(state), value, why)) {
        bytes.put<std::uint8_t>(1);
        bytes.put_string(parts.chart.states[machine.root].path);
        bytes.put_string(given.name);
        bytes.put(value.bytes());
      }
      lua_settop(state, top);
    }
  }
  bytes.put<std::uint8_t>(0);
}

std::size_t machine_at(const Chart& chart, std::string_view path) {
  std::size_t at = 0;
  while (at < chart.machines.size() && chart.states[chart.machines[at].root].path != path) ++at;
  return at;
}

// The machine's part of the bytes: nothing of it counts when the machine is gone or takes no vars of that version.
void take_machine(lua_State* state, Behavior::Parts& parts, ByteReader& bytes) {
  const std::size_t number = machine_at(parts.chart, bytes.take_text());
  const auto version = bytes.take<std::int32_t>();
  const auto size = bytes.take<std::uint32_t>();
  const std::string_view why = size == unkept ? bytes.take_text() : "";
  ByteReader vars(bytes.take_bytes(size == unkept ? 0 : size));
  if (!bytes.ok()) luaL_error(state, "what was kept ends too early");
  if (number == parts.chart.machines.size()) return;
  const Chart::Machine& machine = parts.chart.machines[number];
  if (!parts.runner->active(machine.root) || !takes_vars(machine, version)) return;
  luaL_checkstack(state, 16, "vars");
  if (!why.empty()) {
    lua_pushlstring(state, why.data(), why.size());
    luaL_error(state, "%s: only plain data and motions are carried over", lua_tostring(state, -1));
  }
  push_entry(state, parts.tables.machines[number].content, "vars");
  push_value(state, vars, parts.catalog);
  if (!lua_istable(state, -1)) luaL_error(state, "vars that are no table were kept");
  give_vars(state, machine, version);
  lua_settop(state, 1);
}

// Whether the version that goes on has it evaluated, too, and takes the value at the top of the stack.
bool takes_given(lua_State* state, const Chart::Machine& machine, const Chart::Given& given) {
  const bool constant = given.function == Chart::no_function && given.follows == Chart::no_parameter;
  if (constant || (given.parameter != Chart::no_parameter && given.function == Chart::no_function)) return false;
  if (!push_given_refusal(state, machine, given)) return true;
  lua_pop(state, 1);
  return false;
}

void take_given(lua_State* state, Behavior::Parts& parts, ByteReader& bytes) {
  while (bytes.take<std::uint8_t>() != 0) {
    luaL_checkstack(state, 12, "what a call gives");
    const std::size_t number = machine_at(parts.chart, bytes.take_text());
    const std::string_view name = bytes.take_text();
    push_value(state, bytes, parts.catalog);
    const int top = lua_gettop(state);
    if (number < parts.chart.machines.size() && parts.runner->active(parts.chart.machines[number].root)) {
      const Chart::Machine& machine = parts.chart.machines[number];
      for (std::size_t i = 0; i < machine.calls_with.size(); ++i) {
        if (machine.calls_with[i].name != name || !takes_given(state, machine, machine.calls_with[i])) continue;
        lua_pushvalue(state, top);
        parts.runner->give(state, static_cast<std::uint16_t>(number), i);
      }
    }
    lua_settop(state, top - 1);
  }
}

void renew_machines(lua_State* state, Behavior::Parts& parts, ByteReader& bytes) {
  for (std::size_t i = 0; i < parts.chart.machines.size(); ++i) {
    if (!parts.runner->active(parts.chart.machines[i].root)) continue;
    renew_machine(state, parts.chart, parts.tables, static_cast<std::uint16_t>(i));
  }
  take_given(state, parts, bytes);
  while (bytes.take<std::uint8_t>() != 0) take_machine(state, parts, bytes);
}

struct GoingOn {
  Behavior::Parts& parts;
  ByteReader& bytes;
  RandomStream random;
  bool guards_tried;
};

// With guards that are tried it takes the machines twice: guards may write vars, which they should not.
void take_machines(lua_State* state, const GoingOn& going_on) {
  Behavior::Parts& parts = going_on.parts;
  take_event_data(state, parts, going_on.bytes);
  take_results(state, parts, going_on.bytes);
  ByteReader again = going_on.bytes;
  parts.snapshot_tables.refill(*parts.bindings.snapshot, parts.bindings.now_ns);
  renew_machines(state, parts, going_on.bytes);
  parts.runner->be_at(parts.bindings.now_ns);
  parts.runner->start_runs(state);
  if (!going_on.guards_tried) return;
  parts.lua->core().random = going_on.random;
  parts.runner->try_guards(state);
  renew_machines(state, parts, again);
}

}  // namespace

std::string keep_behavior(Behavior::Parts& parts, ByteWriter& bytes) {
  bytes.put<std::uint8_t>(parts.failed);
  bytes.put(parts.transactions_refused);
  put_parameters(parts, bytes);
  bytes.put<std::uint8_t>(parts.reports.queue_full);
  bytes.put(parts.reports.faults_seen);
  bytes.put(std::as_bytes(std::span(&parts.lua->core().random, 1)));
  put_sent(parts.bindings, bytes);
  put_armed(parts, bytes);
  parts.runner->keep(bytes);
  put_event_data(parts, bytes);
  put_results(parts, bytes);
  put_given(parts, bytes);
  return put_machines(parts, bytes);
}

bool go_on_with(Behavior::Parts& parts, ByteReader& bytes, const Snapshot& snapshot, CommandSender& commands,
                std::uint64_t instructions, bool guards_tried) noexcept {
  LuaCore& core = parts.lua->core();
  parts.failed = bytes.take<std::uint8_t>() != 0;
  parts.transactions_refused = bytes.take<std::uint64_t>();
  take_parameters(parts, bytes);
  parts.reports.queue_full = bytes.take<std::uint8_t>() != 0;
  parts.reports.faults_seen = bytes.take<std::uint64_t>();
  GoingOn going_on{parts, bytes, core.random, guards_tried};
  const auto kept = bytes.take_bytes(sizeof going_on.random);
  if (!kept.empty()) std::memcpy(static_cast<void*>(&going_on.random), kept.data(), sizeof going_on.random);
  take_sent(parts.bindings, bytes);
  take_armed(parts, bytes);
  if (!parts.runner->restore(bytes)) {
    parts.error.set_message("what was kept does not fit the chart");
    return false;
  }
  parts.bindings.begin(commands, snapshot, snapshot.time_ns);
  const bool taken = parts.lua->call([&](lua_State* state) { take_machines(state, going_on); }, instructions,
                                     parts.settings.limits.load_wall_ns);
  commands.discard();  // a guard that commands
  core.random = going_on.random;
  if (taken && parts.runner->started()) parts.want_sets();
  if (!taken) parts.error = parts.lua->error();
  return taken && bytes.ok();
}

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

// Leaves the marked states in a transaction of its own. False: an `exit` raised.
bool leave_states(Behavior::Parts& parts, const std::vector<bool>& marks, const Snapshot& snapshot,
                  CommandSender& commands) noexcept {
  const auto leave = [&](lua_State* state) {
    parts.snapshot_tables.refill(*parts.bindings.snapshot, parts.bindings.now_ns);
    parts.runner->leave_marked(state, marks, parts.bindings.now_ns);
  };
  parts.bindings.begin(commands, snapshot, snapshot.time_ns);
  if (parts.run(leave)) {
    (void)parts.bindings.commit();
    return true;
  }
  commands.discard();
  return false;
}

}  // namespace

std::vector<std::filesystem::path> Behavior::files() const {
  std::vector<std::filesystem::path> all;
  for (const LuaState::Source& source : parts_->lua->sources()) all.push_back(source.path);
  return all;
}

const std::string& Behavior::complaint() const noexcept { return past_->complaint; }

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
  if (const std::string clash = clash_text(fresh->catalog, fresh->bindings.all_sets, elsewhere); !clash.empty()) {
    return refuse(snapshot.time_ns, clash + ", and the other set's behavior plays at the same time");
  }
  ByteWriter kept;
  (void)keep_behavior(*parts_, kept);  // what could not be kept is told when the new version needs it
  ByteReader bytes(kept.bytes());
  if (!go_on_with(*fresh, bytes, snapshot, commands, settings.limits.reload_instructions, true))
    return refuse(snapshot.time_ns, fresh->error.text());
  swap(std::move(fresh), snapshot, commands);
  return Reload::taken;
}

void Behavior::swap(std::unique_ptr<Parts> fresh, const Snapshot& snapshot, CommandSender& commands) noexcept {
  Parts& old = *parts_;
  past_->complaint.clear();
  if (old.runner->started()) {
    past_->left = old.runner->gone_from(*fresh->runner);
    fresh->runner->report_gone(*old.runner, past_->left);
    if (!leave_states(old, past_->left, snapshot, commands)) {
      old.note(BehaviorLog::Severity::warning, "a state that is gone could not be left: " + old.lua->error().text());
    }
    past_->swapped_ns = clock_ns(snapshot);
    past_->parts = std::move(parts_);
  }
  parts_ = std::move(fresh);
  number_states();
  status_->reloads.fetch_add(1, std::memory_order_relaxed);
  parts_->note(BehaviorLog::Severity::info, "reloaded " + parts_->lua->sources().front().chunk);
}

bool Behavior::take_back(const Snapshot& snapshot, CommandSender& commands) noexcept {
  if (past_->parts == nullptr || clock_ns(snapshot) - past_->swapped_ns >= probation_ns) return false;
  Parts& failing = *parts_;
  Parts& old = *past_->parts;
  const ScriptError error = failing.lua->error();
  past_->taken_back = failing.lua->sources();
  if (error.breach == ScriptBreach::none) {  // what the new version entered itself
    (void)leave_states(failing, failing.runner->gone_from(*old.runner), snapshot, commands);
  }
  old.runner->enter_again(past_->left);
  old.bindings.go_on_from(failing.bindings);
  old.want_sets();
  parts_ = std::move(past_->parts);
  number_states();
  parts_->log.message(snapshot.time_ns, BehaviorLog::Severity::warning, name(),
                      "new version taken back, the old one goes on: " + error.text());
  return true;
}

void Behavior::forget_past(std::int64_t now_ns) noexcept {
  if (past_->parts != nullptr && now_ns - past_->swapped_ns >= probation_ns) past_->parts.reset();
}

}  // namespace kadans
