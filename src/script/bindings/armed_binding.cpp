// m:on(condition, function, options): a transaction that waits in the control engine for a condition
// (src/engine/tick/armed_transactions.h). The function runs once, here and now, and only records what to send.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <vector>

#include "bindings.h"
#include "script/check/hint.h"
#include "script/sandbox/handle.h"
#include "script/sandbox/sandbox.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

const HandleKey armed_key = 0;
constexpr double arm_instructions = 2000, condition_instructions = 500, letter_instructions = 1;
constexpr std::size_t hints_max = 40;  // signals among which the one that was meant is looked for

// The data behind the handle that m:on returns.
struct ArmedHandle {
  std::uint32_t sequence = 0;
  std::uint16_t which = 0;
};

// nullptr: its place was taken by another one, or it has not arrived.
const ArmedStatus* find_armed(const Snapshot& snapshot, std::uint32_t sequence, std::uint32_t which) noexcept {
  for (const ArmedStatus& status : snapshot.armed) {
    if (status.state != ArmedState::none && status.sequence == sequence && status.which == which) return &status;
  }
  return nullptr;
}

[[noreturn]] void refuse_condition(lua_State* state, const char* why) {
  luaL_error(state,
             "m:on: %s; a condition is \"foot.right.contact\", \"not foot.right.contact\", \"joint.l_knee.position_rad "
             "> 0.3\", { after_s = 0.1 }, { arrived = m.posture }, or up to %d of them in { all = { ... } } or "
             "{ any = { ... } }",
             why, static_cast<int>(max_armed_conditions));
  __builtin_unreachable();
}

std::string_view trimmed(std::string_view text) noexcept {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::string_view part_of(std::string_view name, std::size_t from) noexcept {
  return name.substr(from, name.find('.', from) - from);
}

// The key of a signal that behaviors may know. The text is at the top of the stack.
std::int64_t check_signal(lua_State* state, std::string_view name) {
  const Bindings& bindings = bindings_of(state);
  if (is_truth_of_simulation(name))
    luaL_error(state, "m:on: '%s' is the truth of a simulation, which no robot knows", lua_tostring(state, -1));
  const SignalName known = condition_signal(bindings, name);
  if (bindings.catalog->signals.find_key(signal_key(known.data()))) return signal_key(known.data());
  const Hint hint = make_hint(state, known.data(), [&](auto& names) { names = signals_near(bindings, known.data()); });
  luaL_error(state, "m:on: unknown signal '%s'%s", known.data(), hint.data());
  return 0;
}

// "not foot.right.contact", "joint.l_knee.position_rad > 0.3"; the text is at the top of the stack.
Command signal_condition(lua_State* state) {
  const ConditionText read = read_condition_text(lua_tostring(state, -1));
  if (read.wrong != nullptr) refuse_condition(state, read.wrong);
  Command command{.kind = CommandKind::condition, .value = read.value};
  command.count = static_cast<std::uint32_t>(read.below ? ConditionKind::below : ConditionKind::above);
  command.time_ns = check_signal(state, read.signal);
  return command;
}

// The condition at the top of the stack.
Command read_condition(lua_State* state) {
  core_of(state).budget.charge(state, condition_instructions);
  if (lua_type(state, -1) == LUA_TSTRING) {
    core_of(state).budget.charge(state, letter_instructions * static_cast<double>(lua_objlen(state, -1)));
    return signal_condition(state);
  }
  if (!lua_istable(state, -1)) refuse_condition(state, "this is no condition");
  Command command{.kind = CommandKind::condition};
  lua_getfield(state, -1, "after_s");
  if (lua_type(state, -1) == LUA_TNUMBER) {
    command.count = static_cast<std::uint32_t>(ConditionKind::after);
    command.value = lua_tonumber(state, -1);
    if (!(command.value >= 0 && command.value <= motion_duration_max_s))
      refuse_condition(state, "after_s is in 0..3600 s");
    return lua_pop(state, 1), command;
  }
  lua_getfield(state, -2, "arrived");
  if (lua_isnil(state, -1)) refuse_condition(state, "this is no condition");
  const std::uint32_t* number = to_object(state, -1);
  if (number == nullptr) refuse_condition(state, "arrived is a control object");
  const ObjectInfo& object = bindings_of(state).catalog->objects[*number];
  lua_pop(state, 2);
  if (object.setpoints.empty()) luaL_error(state, "m:on: '%s' has no set-points", object.name.c_str());
  command.count = static_cast<std::uint32_t>(ConditionKind::arrived);
  command.index = object.setpoints.front();
  return command;
}

struct Conditions {
  std::array<Command, max_armed_conditions> all{};
  std::uint32_t count = 0;
  std::uint32_t options = 0;
};

// The list at the top of the stack.
void read_list(lua_State* state, Conditions& conditions) {
  if (!lua_istable(state, -1)) refuse_condition(state, "all and any take a list");
  const auto count = lua_objlen(state, -1);
  if (count < 1 || count > max_armed_conditions) refuse_condition(state, "there are too many conditions, or none");
  for (; conditions.count < count; ++conditions.count) {
    lua_rawgeti(state, -1, static_cast<int>(conditions.count) + 1);
    conditions.all[conditions.count] = read_condition(state);
    lua_pop(state, 1);
  }
}

Conditions read_conditions(lua_State* state, int index) {
  Conditions conditions;
  lua_pushvalue(state, index);
  if (lua_istable(state, -1)) {
    for (const char* how : {"all", "any"}) {
      lua_getfield(state, -1, how);
      if (!lua_isnil(state, -1)) {
        read_list(state, conditions);
        if (std::strcmp(how, "any") == 0) conditions.options |= arm_any;
        return lua_pop(state, 2), conditions;
      }
      lua_pop(state, 1);
    }
  }
  conditions.all[conditions.count++] = read_condition(state);
  return lua_pop(state, 1), conditions;
}

struct Options {
  double within_s = 0;
  bool every_time = false;
  EventId event = no_event;
};

Options read_options(lua_State* state, int index, Chart& chart) {
  Options options;
  if (!lua_istable(state, index)) luaL_error(state, "m:on needs { within_s = seconds }: for how long it may wait");
  bool timed = false;
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    const std::string_view name = lua_type(state, -2) == LUA_TSTRING ? lua_tostring(state, -2) : "";
    if (name == "within_s" && lua_type(state, -1) == LUA_TNUMBER) {
      options.within_s = lua_tonumber(state, -1);
      timed = options.within_s > 0 && options.within_s <= motion_duration_max_s;
    } else if (name == "every_time" && lua_isboolean(state, -1)) {
      options.every_time = lua_toboolean(state, -1) != 0;
    } else if (name == "event" && lua_type(state, -1) == LUA_TSTRING) {
      options.event = check_event(state, chart, lua_tostring(state, -1));
    } else {
      luaL_error(state, "m:on takes { within_s = seconds, every_time = true or false, event = \"name\" }");
    }
  }
  if (!timed) luaL_error(state, "m:on needs within_s = 0..3600 s: for how long it may wait");
  return options;
}

// Runs the function at index 3 with m, and keeps what it asks for. An error of it is raised again.
void record(lua_State* state) {
  Bindings& bindings = bindings_of(state);
  bindings.recorded_count = 0;
  bindings.recording = true;
  lua_pushvalue(state, 3);
  lua_pushvalue(state, 1);
  const int status = lua_pcall(state, 1, 0, 0);
  bindings.recording = false;
  if (status != 0) {
    core_of(state).budget.raise_again(state);
    lua_error(state);
  }
  if (bindings.recorded_count > max_armed_commands)
    luaL_error(state, "m:on: the function asks for more than %d commands", static_cast<int>(max_armed_commands));
  if (bindings.recorded_count == 0) luaL_error(state, "m:on: the function asks for nothing");
}

// [-0 +1]
void push_handle(lua_State* state, std::uint32_t sequence, std::uint16_t which) {
  new (lua_newuserdata(state, sizeof(ArmedHandle))) ArmedHandle{sequence, which};
  set_kind(state, armed_key);
}

// m:on(condition, function(c) ... end, { within_s = }) -> handle | nil, "queue_full". Upvalue: the chart.
int on(lua_State* state) {
  auto& chart = *static_cast<Chart*>(lua_touserdata(state, lua_upvalueindex(1)));
  Bindings& bindings = bindings_of(state);
  lua_settop(state, 4);
  core_of(state).budget.charge(state, arm_instructions);
  if (bindings.recording) return luaL_error(state, "m:on does not work inside the function of another m:on");
  if (bindings.armed_count == bindings.armed.size())
    return luaL_error(state, "m:on: %d transactions are armed already", static_cast<int>(max_armed));
  if (bindings.runner == nullptr || !bindings.runner->active(bindings.runner->acting_index()))
    return luaL_error(state, "m:on belongs to a state that is active: call it in enter, during or run");
  if (!lua_isfunction(state, 3))
    return luaL_error(state, "m:on needs a function that says what to do: function(c) ... end");
  const Conditions conditions = read_conditions(state, 2);
  const Options options = read_options(state, 4, chart);
  begin_callback(state, "m:on");
  record(state);
  end_callback(state);
  const std::uint32_t flags = conditions.options | (options.every_time ? std::uint32_t{arm_every_time} : 0U);
  bool fits = bindings.send({.kind = CommandKind::arm,
                             .index = conditions.count,
                             .count = conditions.count + bindings.recorded_count,
                             .sequence = flags,
                             .duration_s = options.within_s});
  for (std::uint32_t i = 0; i < conditions.count; ++i) fits = fits && bindings.send(conditions.all[i]);
  for (std::uint32_t i = 0; i < bindings.recorded_count; ++i) fits = fits && bindings.send(bindings.recorded[i]);
  if (!fits) return queue_full(state);
  const ArmedHere& armed = bindings.note_armed(options.event);
  return push_handle(state, armed.sequence, armed.which), 1;
}

// m:use(set): inside the function of m:on only; elsewhere a state's `controls` say so.
int use(lua_State* state) {
  Bindings& bindings = bindings_of(state);
  const char* name = luaL_checkstring(state, 2);
  if (!bindings.recording)
    return luaL_error(state, "use() works inside the function of m:on; states name their sets in controls");
  const auto& sets = bindings.catalog->sets;
  const auto number = &check_named(state, sets, name, "control set") - sets.data();
  (void)bindings.send({.kind = CommandKind::switch_set, .index = static_cast<std::uint32_t>(number)});
  return 0;
}

ArmedHandle& check_handle(lua_State* state) {
  auto* handle = static_cast<ArmedHandle*>(to_handle(state, 1, armed_key));
  if (handle == nullptr) luaL_error(state, "call it with a colon: armed:cancel()");
  return *handle;
}

// armed:cancel() -> true | nil, "queue_full".
int cancel_armed(lua_State* state) {
  const ArmedHandle& handle = check_handle(state);
  Bindings& bindings = bindings_of(state);
  if (bindings.recording) return luaL_error(state, "armed:cancel() does not work inside the function of m:on");
  return tell_sent(state,
                   bindings.send({.kind = CommandKind::disarm, .index = handle.which, .sequence = handle.sequence}));
}

const char* outcome(const ArmedHandle& handle, const ArmedStatus* status, const Snapshot& snapshot) noexcept {
  constexpr const char* names[] = {"over", "waits", "done", "refused", "expired", "taken_back"};  // as ArmedState
  if (status != nullptr) return names[static_cast<std::size_t>(status->state)];
  if (std::ranges::find(snapshot.refusals, handle.sequence, &Refusal::sequence) != snapshot.refusals.end())
    return "refused";
  return snapshot.transactions_applied < handle.sequence ? "waits" : "over";
}

// armed.outcome, .fired, .cancel; upvalue: the methods.
int read_armed_field(lua_State* state) {
  const ArmedHandle& handle = check_handle(state);
  const Snapshot& snapshot = *bindings_of(state).snapshot;
  const ArmedStatus* status = find_armed(snapshot, handle.sequence, handle.which);
  const std::string_view name = lua_type(state, 2) == LUA_TSTRING ? lua_tostring(state, 2) : "";
  if (name == "outcome") return lua_pushstring(state, outcome(handle, status, snapshot)), 1;
  if (name == "fired") return lua_pushnumber(state, status != nullptr ? status->fired : 0), 1;
  return push_method(state, "an armed transaction");
}

}  // namespace

SignalName condition_signal(const Bindings& bindings, std::string_view name) noexcept {
  constexpr std::size_t foot_at = 5;  // behind "foot."
  SignalName text{};
  std::string_view foot = name.starts_with("foot.") ? part_of(name, foot_at) : std::string_view{}, link = foot;
  const auto known = std::ranges::find(bindings.catalog->feet, foot, &FootInfo::name);
  if (known != bindings.catalog->feet.end()) link = known->link;
  const std::string_view rest = foot.empty() ? name : name.substr(foot_at + foot.size());
  std::snprintf(text.data(), text.size(), "%s%.*s%.*s", foot.empty() ? "" : "foot.", static_cast<int>(link.size()),
                link.data(), static_cast<int>(rest.size()), rest.data());
  return text;
}

bool is_truth_of_simulation(std::string_view name) noexcept {
  return name.starts_with("plant.") || name.starts_with("reference.") || name.starts_with("world.");
}

// Of the same topic: those of the same owner, and those of the same quantity.
std::vector<std::string> signals_near(const Bindings& bindings, std::string_view wanted) {
  const std::string_view topic = part_of(wanted, 0);
  const std::string_view owner = part_of(wanted, std::min(wanted.size(), topic.size() + 1));
  const std::string_view quantity = wanted.substr(std::min(wanted.rfind('.'), wanted.size()));
  std::vector<std::string> names;
  for (SignalId id = 0; id < bindings.catalog->signals.size() && names.size() < hints_max; ++id) {
    const std::string& other = bindings.catalog->signals.info(id).name;
    if (part_of(other, 0) != topic || other.size() == topic.size()) continue;
    const bool near = part_of(other, topic.size() + 1) == owner || std::string_view(other).ends_with(quantity);
    if (near) names.push_back(other);
  }
  return names;
}

ConditionText read_condition_text(std::string_view text) noexcept {
  text = trimmed(text);
  ConditionText read{.signal = text};
  const std::size_t sign = text.find_first_of("<>");
  if (text.find('=') != std::string_view::npos) {
    read.wrong = "a condition compares with < or >, not with =";
  } else if (sign != std::string_view::npos) {
    const std::optional<double> number = number_of<double>(trimmed(text.substr(sign + 1)));
    if (!number) read.wrong = "behind < or > stands a number";
    read.value = number.value_or(0);
    read.below = text[sign] == '<';
    read.signal = trimmed(text.substr(0, sign));
  } else if (text.starts_with("not ")) {
    read.below = true;
    read.signal = trimmed(text.substr(4));
  }
  return read;
}

const ArmedHere& Bindings::note_armed(EventId event) noexcept {
  ArmedHere& here = armed[armed_count++];
  here = {.sequence = sender->last_sequence() + 1,
          .which = armed_in_tick++,
          .owner = runner->acting_index(),
          .event = event};
  return here;
}

void Bindings::take_back(StateIndex owner) noexcept {
  for (std::uint32_t i = armed_count; i-- > 0;) {
    if (armed[i].owner != owner) continue;
    (void)send({.kind = CommandKind::disarm, .index = armed[i].which, .sequence = armed[i].sequence});
    drop_armed(i);
  }
}

void Bindings::take_back_orphans() noexcept {
  for (std::uint32_t i = armed_count; i-- > 0;) {
    if (i >= armed_count) continue;  // taken back with another one
    if (armed[i].owner == no_state || !runner->active(armed[i].owner)) take_back(armed[i].owner);
  }
}

void Bindings::drop_armed(std::uint32_t index) noexcept {
  std::copy(armed.begin() + index + 1, armed.begin() + armed_count, armed.begin() + index);
  --armed_count;
}

bool Bindings::look_at_armed(ArmedHere& told, ArmedStatus& status) noexcept {
  for (std::uint32_t i = 0; i < armed_count; ++i) {
    ArmedHere& here = armed[i];
    const ArmedStatus* now = find_armed(*snapshot, here.sequence, here.which);
    const bool known = now != nullptr;
    const bool ended = known ? now->state != ArmedState::waits : snapshot->transactions_applied >= here.sequence;
    if (!ended && (!known || now->fired == here.fired)) continue;
    told = here;
    status = known ? *now : ArmedStatus{.sequence = here.sequence};
    if (known) here.fired = now->fired;
    if (ended) drop_armed(i);
    return true;
  }
  return false;
}

bool Bindings::was_armed(std::uint32_t sequence) const noexcept {
  return std::ranges::any_of(snapshot->armed, [sequence](const ArmedStatus& status) {
    return status.sequence == sequence && status.state == ArmedState::refused;
  });
}

void Bindings::forget_armed(std::uint32_t sequence) noexcept {
  for (std::uint32_t i = armed_count; i-- > 0;) {
    if (armed[i].sequence == sequence) drop_armed(i);
  }
}

void open_armed(lua_State* state, const Chart& chart) {
  lua_pushlightuserdata(state, const_cast<Chart*>(&chart));
  lua_pushcclosure(state, on, 1);
  lua_setfield(state, -2, "on");
  lua_pushcfunction(state, use);
  lua_setfield(state, -2, "use");
}

void open_armed_handles(lua_State* state) {
  const luaL_Reg methods[] = {{"cancel", cancel_armed}};
  open_kind(state, armed_key, methods, read_armed_field);
}

}  // namespace kadans
