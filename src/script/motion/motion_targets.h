// Reads the set-points that a motion moves and their targets: a pose by name, a table joint = position, or one
// set-point. All functions raise at the author's line and send nothing.
#pragma once

#include <array>
#include <cstdint>

#include <lua.hpp>

#include "kadans/control/catalog.h"
#include "motion_options.h"

namespace kadans {

struct MotionTarget {
  SetpointId id = 0;
  double value = 0;
  SetpointState from;  // the present set-point; set by place_targets
};

struct MotionTargets {
  std::array<MotionTarget, max_joints> all;
  std::uint32_t count = 0;
  const MotionTarget* begin() const noexcept { return all.data(); }
  const MotionTarget* end() const noexcept { return all.data() + count; }
};

// Reads the pose at `index`: its name, or a table joint = rad. `called` is the method's name for messages.
void read_pose(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets);
// The set-point that is named at `index`.
SetpointId read_setpoint(lua_State* state, int index, const ObjectInfo& object);

// The present set-point from the snapshot, or the position of its joint when its object is not active yet. Raises when
// the control object does not report it.
SetpointState present_setpoint(lua_State* state, SetpointId id);
// Adds offsets, checks ranges, and finds the start of the motion if it is needed.
void place_targets(lua_State* state, const MotionOptions& options, bool planned, MotionTargets& targets);

}  // namespace kadans
