// A motion that a behavior asked for, as its handle in Lua knows it.
//
// It is pending until the tick's transaction is sent, sent until the control engine says that it applied the
// transaction, and done when the object is at rest or the motion's time has passed since. Refused: the control engine
// said that it refused the transaction; expired: it never said anything.
#pragma once

#include <cstdint>

#include <lua.hpp>

#include "kadans/signal/refusal.h"
#include "kadans/signal/setpoint.h"
#include "kadans/signal/status.h"

namespace kadans {

enum class MotionState : std::uint8_t { pending, sent, applied, done, cancelled, queue_full, refused, expired };

struct Motion {
  MotionState state = MotionState::pending;
  std::uint32_t object = 0;
  std::uint32_t sequence = 0;
  std::int64_t asked_ns = 0, applied_ns = 0;
  double duration_s = 0;
  Refusal refusal;          // when it was refused
  std::uint32_t count = 0;  // set-points, stored behind this struct

  SetpointId* setpoints() noexcept { return reinterpret_cast<SetpointId*>(this + 1); }
  bool over() const noexcept { return state >= MotionState::done; }
};

// Brings the state up to date.
void observe(Motion& motion, const Snapshot& snapshot, std::int64_t now_ns) noexcept;
// Why it did not arrive, for Lua: nullptr when it did.
const char* failure(const Motion& motion) noexcept;
// [-0 +1] What was wrong with it, for people: nil unless it was refused.
void push_reason(lua_State* state, const Motion& motion);

// [-0 +1] A new handle with room for `count` set-points.
Motion* push_motion(lua_State* state, std::uint32_t count);
// The handle at `index`, or nullptr.
Motion* to_motion(lua_State* state, int index);
void open_motions(lua_State* state);

}  // namespace kadans
