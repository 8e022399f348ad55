// `s`: the snapshot as scripts see it. The tables are made once; each tick only their numbers are replaced.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <lua.hpp>

#include "kadans/model/robot_model.h"
#include "kadans/signal/status.h"

namespace kadans {

class SnapshotTables {
 public:
  // Makes the tables; `feet` names the feet in their order. Returns the registry reference of `s`. Raises.
  int open(lua_State* state, const RobotModel& model, const std::vector<std::string>& feet);
  // Raises only when out of memory; keys that exist are replaced without allocation.
  void refill(lua_State* state, const Snapshot& snapshot, std::int64_t now_ns) const;

 private:
  std::size_t joints_ = 0, feet_ = 0;
  int keys_ = 0, joint_tables_ = 0, foot_tables_ = 0, root_ = 0, base_ = 0, rate_ = 0, support_ = 0, safety_ = 0,
      levels_ = 0;
};

}  // namespace kadans
