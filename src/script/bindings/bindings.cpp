
#include "bindings.h"

#include <algorithm>
#include <utility>

#include "script/chart/chart_arguments.h"
#include "script/chart/chart_reader.h"
#include "script/chart/chart_skills.h"
#include "script/check/hint.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"

namespace kadans {

void Bindings::want(SetMask sets, SetMask needed) noexcept {
  wanted &= sets;
  bring_in(needed);
  bring_in_again();
}

void Bindings::bring_in(SetMask sets) noexcept {
  each_bit(sets & ~sets_now, [&](std::uint32_t set) {
    wanted |= set_bit(set);
    sets_now = partition->after(sets_now, set);
    (void)send({.kind = CommandKind::switch_set, .index = set});
  });
}

void Bindings::bring_in_again() noexcept {
  each_bit(wanted, [&](std::uint32_t set) {
    if (!must_wait(set)) bring_in(set_bit(set));
  });
}

bool Bindings::must_wait(std::uint32_t set) const noexcept {
  const SetMask changed = sets_now ^ partition->after(sets_now, set);
  bool dwells = false;
  each_bit(partition->objects(changed), [&](std::uint32_t object) {
    dwells = dwells || (object < snapshot->object_count && snapshot->objects[object].dwell_s > 0);
  });
  return dwells;
}

const Refusal* Bindings::next_refusal() noexcept {
  const std::uint32_t count = snapshot->transactions_refused;
  if (count - refusals_seen > refusals_shown) refusals_seen = count - refusals_shown;
  while (refusals_seen != count) {
    const Refusal& refusal = snapshot->refusals[refusals_seen++ % refusals_shown];
    if (std::find(sent.begin(), sent.end(), refusal.sequence) == sent.end()) continue;
    refused_last = refusal.sequence;
    return &refusal;
  }
  return nullptr;
}

bool Bindings::send(const Command& command) noexcept {
  if (recording) {
    if (recorded_count < recorded.size()) recorded[recorded_count] = command;
    ++recorded_count;
    return true;
  }
  if (sender->add(command)) return true;
  refused = true;
  return false;
}

void Bindings::begin(CommandSender& to, const Snapshot& seen, std::int64_t time_ns) noexcept {
  sender = &to;
  snapshot = &seen;
  now_ns = time_ns - held_ns;
  refused = false;
  motion_count = cancelled_count = 0;
  recording = false;
  armed_in_tick = 0;
  if (!std::exchange(begun, true)) switched = to.last_switch();  // of a behavior before
  if (sets_known()) sets_sent = seen.control_sets;
  sets_now = sets_sent;
  to.begin(time_ns);
}

Bindings::Mark Bindings::mark() const noexcept {
  return {sender->mark(), refused,       motion_count,       cancelled_count,
          armed_count,    armed_in_tick, sent_events.size(), decided.size()};
}

void Bindings::take_back_to(const Mark& mark) noexcept {
  sender->take_back_to(mark.sent);
  refused = mark.refused;
  recording = false;
  for (std::uint32_t i = mark.cancelled; i < cancelled_count; ++i) cancelled[i]->state = cancelled[i]->before;
  cancelled_count = mark.cancelled;
  for (std::uint32_t i = mark.motions; i < motion_count; ++i) motions[i]->state = MotionState::cancelled;
  motion_count = mark.motions;
  armed_count = mark.armed;
  armed_in_tick = mark.armed_in_tick;
  sent_events.erase(sent_events.begin() + static_cast<std::ptrdiff_t>(mark.events), sent_events.end());
  decided.erase(decided.begin() + static_cast<std::ptrdiff_t>(mark.decided), decided.end());
}

// Each has a command in the transaction, so there is room for all.
void Bindings::note_cancelled(Motion& motion) noexcept {
  motion.before = std::exchange(motion.state, MotionState::cancelled);
  if (cancelled_count < cancelled.size()) cancelled[cancelled_count++] = &motion;
}

bool Bindings::commit() noexcept {
  const std::uint32_t sequence = sender->commit();
  const bool taken = !refused && (sequence != 0 || sender->last_sequence() == 0);
  if (taken) {
    wanted &= ~sets_now;
    sets_sent = sets_now;
    if (sender->last_switch() == sequence) switched = sequence;
  }
  if (taken && !sender->committed().empty()) sent[sent_count++ % sent.size()] = sequence;
  for (std::uint32_t i = 0; i < cancelled_count; ++i) {
    if (!taken) cancelled[i]->state = cancelled[i]->before;
    cancelled[i]->cancel_sequence = taken ? sequence : 0;
  }
  cancelled_count = 0;
  for (std::uint32_t i = 0; i < motion_count; ++i) {
    Motion& motion = *motions[i];
    motion.sequence = sequence;
    if (motion.state == MotionState::pending) motion.state = taken ? MotionState::sent : MotionState::queue_full;
  }
  motion_count = 0;
  if (!taken && armed_in_tick > 0) forget_armed(sender->last_sequence() + 1);
  return taken;
}

// The table that require "kadans" returns.

namespace {

constexpr double joint_instructions = 20;

// budget() -> { instructions =, memory_bytes = }: what is left.
int budget(lua_State* state) {
  const LuaCore& core = core_of(state);
  lua_createtable(state, 0, 2);
  set_field(state, "instructions", static_cast<lua_Number>(core.budget.left()));
  const std::size_t used = core.heap.used_bytes(), limit = core.heap.limit_bytes();
  set_field(state, "memory_bytes", static_cast<lua_Number>(used < limit ? limit - used : 0));
  return 1;
}

// pose(name) -> { joint = position in rad }: a copy of a pose in the robot's configuration.
int pose(lua_State* state) {
  const char* name = luaL_checkstring(state, 1);
  if (core_of(state).bindings == nullptr) return luaL_error(state, "no robot here has poses");
  const Catalog& catalog = *bindings_of(state).catalog;
  const PoseInfo& known = check_named(state, catalog.poses, name, "pose");
  core_of(state).budget.charge(state, joint_instructions * static_cast<double>(known.position_rad.size()));
  lua_newtable(state);
  for (const auto& [joint, position_rad] : known.position_rad)
    set_field(state, catalog.model->joints[joint].name.c_str(), position_rad);
  return 1;
}

// k.log: lines for people, in the record and on the console, each with its severity.

constexpr double charge_instructions = 1000;  // as for print

// log.info(format [, ...]): the format of string.format when there is more than one argument. Upvalue: severity.
int log_line(lua_State* state) {
  if (lua_type(state, 1) != LUA_TSTRING)
    return luaL_error(state, "log needs a text: log.info(\"height %%.2f m\", s.base.height_m)");
  const int count = lua_gettop(state);
  if (count > 1) {
    push_environment(state);
    lua_getfield(state, -1, "string");
    lua_getfield(state, -1, "format");
    lua_insert(state, 1);
    lua_settop(state, count + 1);
    lua_call(state, count, 1);
  }
  LuaCore& core = core_of(state);
  core.budget.charge(state, charge_instructions);
  const auto severity = static_cast<BehaviorLog::Severity>(lua_tointeger(state, lua_upvalueindex(1)));
  ScriptVoice* voice = core.owner->settings().voice;
  if (voice != nullptr) voice->say_with(severity, lua_tostring(state, 1));
  return 0;
}

// [-0 +0] Adds `log` to the module's table at the top of the stack.
void open_log(lua_State* state) {
  constexpr const char* names[] = {"info", "warning", "error"};  // as BehaviorLog::Severity
  lua_createtable(state, 0, 3);
  for (int i = 0; i < 3; ++i) {
    lua_pushinteger(state, i);
    lua_pushcclosure(state, log_line, 1);
    lua_setfield(state, -2, names[i]);
  }
  make_read_only(state, "kadans.log");
  lua_setfield(state, -2, "log");
}

}  // namespace

void open_kadans_module(lua_State* state) {
  lua_newtable(state);
  open_parameters(state);
  open_events(state);
  open_arguments(state);
  open_skills(state);
  open_nodes(state);
  lua_pushcfunction(state, budget);
  lua_setfield(state, -2, "budget");
  lua_pushcfunction(state, pose);
  lua_setfield(state, -2, "pose");
  open_log(state);
  make_read_only(state, "kadans");
}

}  // namespace kadans
