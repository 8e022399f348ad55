// The set-point table: what control objects can be told to reach. Names are for people and scripts; commands address
// set-points by number. Each set-point is a channel of its owner, a control object.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "kadans/signal/fault.h"

namespace kadans {

using SetpointId = std::uint32_t;

struct Setpoint {
  std::string name;  // "posture.l_knee.position_rad"
  std::string unit;
  double min = 0, max = 0;
  std::string doc;
  std::uint32_t owner = 0;    // the control object's index
  std::uint32_t channel = 0;  // the object's own number for it
  std::uint32_t joint = 0;    // the joint it moves, or no_joint
  bool own_motion = false;    // its object plans the way to a plain set-point; else the engine does
  // What it gets when the robot goes to the safe posture of its configuration; NaN: nothing, unless it is a joint's
  // position.
  double safe = std::numeric_limits<double>::quiet_NaN();
  bool follows = false;  // its object can be led along a motion that the engine plans
};

// Where a set-point is on its way and how it moves there: in its unit, per s and per s2.
struct SetpointState {
  double value = 0, velocity = 0, acceleration = 0;
};

class SetpointTable {
 public:
  // Before the loop. Throws std::invalid_argument on a name that is taken or an empty range.
  SetpointId add(Setpoint setpoint);
  void set_follows(SetpointId id) { entries_.at(id).follows = true; }

  // Control thread: whether the id is known and the value finite and within the range.
  bool accepts(SetpointId id, double value) const noexcept {
    return id < entries_.size() && std::isfinite(value) && value >= entries_[id].min && value <= entries_[id].max;
  }
  // Any thread; id < size().
  const Setpoint& operator[](SetpointId id) const noexcept { return entries_[id]; }

  // Any thread: the declarations do not change once the loop runs.
  std::optional<SetpointId> find(std::string_view name) const;
  std::size_t size() const noexcept { return entries_.size(); }
  std::vector<std::string> names() const;

 private:
  std::vector<Setpoint> entries_;
  std::unordered_map<std::string, SetpointId> ids_;
};

}  // namespace kadans
