// A motion that a behavior asked for: the data behind its handle in Lua.
//
// It is pending until the tick's transaction is sent. It is sent until the control engine reports that the transaction
// was applied. It is done when the object is at rest, or when the motion's time has passed since it was applied. It is
// refused when the control engine reports that it refused the transaction, and expired when the engine never reports
// anything. When it was cancelled, but the transaction with that is dropped or refused, it goes on.
#pragma once

#include <cstdint>

#include <lua.hpp>

#include "kadans/signal/command.h"
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
  Refusal refusal;                            // set when it was refused
  MotionState before = MotionState::pending;  // when it was cancelled
  std::uint32_t cancel_sequence = 0;          // of the transaction with that, until the engine has applied it
  std::uint32_t count = 0;                    // number of set-points, which are stored behind this struct

  SetpointId* setpoints() noexcept { return reinterpret_cast<SetpointId*>(this + 1); }
  bool over() const noexcept { return state >= MotionState::done; }
};

// Updates the state from the snapshot.
void observe(Motion& motion, const Snapshot& snapshot, std::int64_t now_ns) noexcept;
// The name of the failure for Lua; nullptr when the motion has not failed.
const char* failure(const Motion& motion) noexcept;
// [-0 +1] Pushes the reason of a refusal as text for people; nil when it was not refused.
void push_reason(lua_State* state, const Motion& motion);

// [-0 +1] Pushes a new handle with room for `count` set-points.
Motion* push_motion(lua_State* state, std::uint32_t count);
// The handle at `index`, or nullptr.
Motion* to_motion(lua_State* state, int index);
void open_motions(lua_State* state);

}  // namespace kadans
