// Which control sets can be active together: those whose joints are disjoint. A set that comes in takes the place of
// all active sets that share a joint with it. These leave as a whole, because a law without some of its joints would be
// another law. The other sets go on unchanged.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "kadans/control/catalog.h"

namespace kadans {

using JointMask = std::uint64_t;  // one bit per joint
using ObjectMask = std::uint32_t;
static_assert(max_joints <= 64 && max_objects <= 32);

constexpr SetMask set_bit(std::uint32_t set) noexcept { return SetMask{1} << set; }
constexpr JointMask joint_bit(std::size_t joint) noexcept { return JointMask{1} << joint; }

// Calls call(number) for each bit of a mask, from the lowest.
template <typename Mask, typename Call>
void each_bit(Mask mask, Call call) {
  for (; mask != 0; mask &= mask - 1) call(static_cast<std::uint32_t>(std::countr_zero(mask)));
}

class SetPartition {
 public:
  // Throws std::invalid_argument on more than max_control_sets sets.
  explicit SetPartition(const Catalog& catalog);

  // The active sets after `set` came in to `active`.
  SetMask after(SetMask active, std::uint32_t set) const noexcept {
    if ((active & set_bit(set)) != 0) return active;
    return (active & ~sets_[set].touched) | set_bit(set);
  }
  // Whether a set of `a` and a different set of `b` share a joint or an object.
  bool clash(SetMask a, SetMask b) const noexcept;
  JointMask joints(SetMask sets) const noexcept;
  ObjectMask objects(SetMask sets) const noexcept;
  std::size_t size() const noexcept { return sets_.size(); }

 private:
  struct Set {
    JointMask joints = 0;
    ObjectMask objects = 0;
    SetMask touched = 0;  // the other sets that cannot be active with it
  };
  std::vector<Set> sets_;
};

// The joints that no active control set holds. A spring and a damper from the configuration draw each of them back to
// where it was when it was let go. With stiffness 0 the joint is only damped, with both 0 it is off.
//
// One owner, the control thread; nothing here allocates after construction, locks or throws.
class UnheldJoints {
 public:
  explicit UnheldJoints(std::vector<UnheldLaw> laws) : laws_(std::move(laws)) {}

  // When the sets change. `held`: the joints that the sets hold from now on. A joint that was unheld before keeps the
  // position to which it is drawn.
  void let_go(JointMask held, const JointStates& joints) noexcept;
  void forget() noexcept { unheld_ = 0; }
  void pass_state(auto& bytes) noexcept {
    bytes(unheld_);
    for (std::size_t joint = 0; joint < laws_.size(); ++joint) bytes(position_rad_[joint]);
    bytes.must(static_cast<std::size_t>(std::bit_width(unheld_)) <= laws_.size());
  }
  // Each tick.
  void step(const JointStates& joints, ActuationFrame& actuation) const noexcept;

 private:
  std::vector<UnheldLaw> laws_;  // by joint
  JointMask unheld_ = 0;
  std::array<double, max_joints> position_rad_{};
};

}  // namespace kadans
