#include "motion.h"

#include <algorithm>

#include "engine/refusal_text.h"
#include "script/bindings/bindings.h"
#include "script/sandbox/handle.h"

namespace kadans {
namespace {

const HandleKey motion_key = 0;
constexpr std::int64_t patience_ns = 1'000'000'000;  // beyond its duration, for a transaction that is never applied

Motion* check_motion(lua_State* state, const char* method) {
  Motion* motion = to_motion(state, 1);
  if (motion == nullptr) luaL_error(state, "call it with a colon: motion:%s()", method);
  return motion;
}

// motion:wait() -> true | nil, outcome, reason. Inside `run` only: goes on when the motion is over.
int wait_for_motion(lua_State* state) {
  Motion* motion = check_motion(state, "wait");
  LuaCore& core = core_of(state);
  Bindings& bindings = bindings_of(state);
  if (core.running != state) return luaL_error(state, "wait() works inside `run` only, not in a coroutine within it");
  observe(*motion, *bindings.snapshot, bindings.now_ns);
  bindings.runner->wait_for(motion);
  lua_settop(state, 1);  // keeps the handle alive
  return lua_yield(state, 1);
}

// motion:cancel() -> true | nil, "queue_full". Comes to rest where it is.
int cancel(lua_State* state) {
  Motion* motion = check_motion(state, "cancel");
  Bindings& bindings = bindings_of(state);
  if (bindings.recording) return luaL_error(state, "inside the function of m:on an object's hold() ends its motions");
  observe(*motion, *bindings.snapshot, bindings.now_ns);
  if (motion->over()) return lua_pushboolean(state, 1), 1;
  for (std::uint32_t i = 0; i < motion->count; ++i) {
    if (!bindings.send({.kind = CommandKind::cancel_motion, .index = motion->setpoints()[i]})) return queue_full(state);
  }
  bindings.note_cancelled(*motion);
  return lua_pushboolean(state, 1), 1;
}

// motion.done, .outcome, .reason, .wait, .cancel; upvalue: the methods.
int read_field(lua_State* state) {
  Motion* motion = check_motion(state, "wait");
  const std::string_view name = lua_type(state, 2) == LUA_TSTRING ? lua_tostring(state, 2) : "";
  if (name == "done" || name == "outcome" || name == "reason") {
    const Bindings& bindings = bindings_of(state);
    observe(*motion, *bindings.snapshot, bindings.now_ns);
    if (name == "done") return lua_pushboolean(state, motion->over() ? 1 : 0), 1;
    if (name == "reason") return push_reason(state, *motion), 1;
    const char* why = failure(*motion);
    return lua_pushstring(state, why != nullptr ? why : motion->over() ? "done" : "moving"), 1;
  }
  return push_method(state, "a motion");
}

}  // namespace

void observe(Motion& motion, const Snapshot& snapshot, std::int64_t now_ns) noexcept {
  const auto seconds = [](std::int64_t ns) { return static_cast<double>(ns) / 1e9; };
  const auto find_refusal = [&](std::uint32_t sequence) {
    return std::ranges::find(snapshot.refusals, sequence, &Refusal::sequence);
  };
  if (motion.state == MotionState::cancelled && motion.cancel_sequence != 0) {
    const bool refused = find_refusal(motion.cancel_sequence) != snapshot.refusals.end();
    if (refused) motion.state = motion.before == MotionState::pending ? MotionState::sent : motion.before;
    if (refused || snapshot.transactions_applied >= motion.cancel_sequence) motion.cancel_sequence = 0;
  }
  if (motion.state == MotionState::sent) {
    const auto refused = find_refusal(motion.sequence);
    if (refused != snapshot.refusals.end()) {
      motion.state = MotionState::refused;
      motion.refusal = *refused;
    } else if (snapshot.transactions_applied >= motion.sequence) {
      motion.state = MotionState::applied;
      motion.applied_ns = now_ns;
    } else if (seconds(now_ns - motion.asked_ns - patience_ns) > motion.duration_s) {
      motion.state = MotionState::expired;
    }
  }
  if (motion.state != MotionState::applied) return;
  const bool at_rest = motion.object < snapshot.object_count && snapshot.objects[motion.object].motion_remaining_s <= 0;
  if (at_rest || seconds(now_ns - motion.applied_ns) >= motion.duration_s) motion.state = MotionState::done;
}

const char* failure(const Motion& motion) noexcept {
  constexpr const char* failures[] = {"cancelled", "queue_full", "refused", "expired"};  // as of MotionState
  static_assert(std::size(failures) ==
                static_cast<int>(MotionState::expired) - static_cast<int>(MotionState::cancelled) + 1);
  if (motion.state < MotionState::cancelled) return nullptr;
  return failures[static_cast<int>(motion.state) - static_cast<int>(MotionState::cancelled)];
}

void push_reason(lua_State* state, const Motion& motion) {
  if (motion.state != MotionState::refused) return lua_pushnil(state);
  char text[200];
  copy_refusal_text(motion.refusal, *bindings_of(state).catalog, text);
  lua_pushstring(state, text);
}

Motion* push_motion(lua_State* state, std::uint32_t count) {
  void* block = lua_newuserdata(state, sizeof(Motion) + count * sizeof(SetpointId));
  auto* motion = new (block) Motion{};
  motion->count = count;
  set_kind(state, motion_key);
  return motion;
}

Motion* to_motion(lua_State* state, int index) { return static_cast<Motion*>(to_handle(state, index, motion_key)); }

void open_motions(lua_State* state) {
  const luaL_Reg methods[] = {{"wait", wait_for_motion}, {"cancel", cancel}};
  open_kind(state, motion_key, methods, read_field);
}

}  // namespace kadans
