// Which set-points a motion moves, and where to: a pose by name, a table joint = position, or one set-point. Everything
// here raises at the author's line and sends nothing.
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
  SetpointState from;  // where the set-point is; known when placed
};

struct MotionTargets {
  std::array<MotionTarget, max_joints> all;
  std::uint32_t count = 0;
  const MotionTarget* begin() const noexcept { return all.data(); }
  const MotionTarget* end() const noexcept { return all.data() + count; }
};

// Of the pose at `index`: its name, or a table joint = rad. `called` is the method.
void read_pose(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets);
// Of the set-point named at `index`.
SetpointId read_setpoint(lua_State* state, int index, const ObjectInfo& object);

// Where the set-point is now, as the snapshot tells; where its joint is when its object is not active yet. Raises when
// the control object cannot tell.
SetpointState present_setpoint(lua_State* state, SetpointId id);
// Adds offsets, checks ranges, and finds where the motion begins if it must be known.
void place_targets(lua_State* state, const MotionOptions& options, bool planned, MotionTargets& targets);

}  // namespace kadans
