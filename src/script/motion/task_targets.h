// The targets of an object that moves more than joints, as a behavior writes them:
//
//   { com_m = { 0.02, 0, 0.55 }, foot_left = { position_m = { nil, nil, 0.03 }, roll_rad = 0 }, l_knee = 0.4 }
//
// The words follow from the names of the set-points. One component of a vector is written in a list: com_x_m, com_y_m
// and com_z_m are com_m = { x, y, z }. A name before a dot is a table of its own: foot_left.roll_rad. A joint's
// position_rad is the joint's name alone. What is left out, or nil, stays as it is.
#pragma once

#include <array>
#include <string_view>

#include <lua.hpp>

#include "motion_options.h"

namespace kadans {

// Without the heap: Lua may raise while it lives.
struct TaskWord {
  using Text = std::array<char, 64>;
  Text group{};  // "" without one
  Text key{};
  int axis = 0;  // 1, 2, 3: component of a vector; 0: a number

  const Text& outer() const noexcept { return group[0] != '\0' ? group : key; }  // what stands in the table of tasks
};
// Of a set-point's name without its object's.
TaskWord task_word(std::string_view short_name, bool of_joint) noexcept;

// Whether it has set-points that belong to no joint.
bool has_tasks(const Catalog& catalog, const ObjectInfo& object) noexcept;
// Reads the table at `index`. Raises on a word that is unknown, a value that is no number, and on no value at all.
void read_tasks(lua_State* state, int index, const ObjectInfo& object, const char* called, MotionTargets& targets);

// What a motion says of its tasks beside their targets.
struct TaskOptions {
  static constexpr std::uint32_t commands_max = 2 * max_joints;
  std::array<Command, commands_max> commands;
  std::uint32_t count = 0;
};
// Reads weight, priority and contacts of the options at `index`.
void read_task_options(lua_State* state, int index, const ObjectInfo& object, const MotionTargets& targets,
                       TaskOptions& options);

}  // namespace kadans
