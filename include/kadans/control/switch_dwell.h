// The least time that a control set or a control object stays once it has come in (`switch_dwell_s`). Switching between
// stable controllers can be unstable when it is fast (Liberzon, Switching in Systems and Control, 2003, sec. 3.2: dwell
// time). A switch that comes too early is refused, not delayed. A set dwells from its own coming in; an object from its
// start, in whatever sets it stays meanwhile. The sets of the start do not dwell.
//
// One owner, the control thread; nothing here allocates after construction, locks or throws.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kadans/control/set_partition.h"

namespace kadans {

class SwitchDwell {
 public:
  // Keeps references. Throws std::invalid_argument on a time that is not 0..switch_dwell_max_s.
  SwitchDwell(const Catalog& catalog, const SetPartition& partition);

  bool demanded() const noexcept { return demanded_; }  // by any set or object
  // Declares the signal composition.<set>.dwell_s of each set that can dwell.
  void declare(SignalTable& signals) const;
  // In a tick in which the active sets may have changed.
  void note(SetMask active, std::int64_t time_ns) noexcept;
  // Each tick, when any is demanded: for how long each set will still dwell in the next tick.
  void step(std::int64_t time_ns, double dt_s) noexcept;

  struct Dweller {
    std::uint32_t set = 0;
    double left_s = 0;  // 0: none dwells
  };
  // The set that dwells longest of those that `set` would take the place of. `active`: the sets before the switch; those
  // that are not active yet come in with an earlier switch of the same tick.
  Dweller against(SetMask active, std::uint32_t set, std::int64_t time_ns) const noexcept;
  // For how long the object, or an active set with it, will still dwell in the next tick.
  double left_s(std::uint32_t object) const noexcept;

 private:
  struct Stay {
    std::int64_t demanded_ns = 0, until_ns = 0;
  };
  static std::int64_t left_ns(const Stay& stay, bool active, std::int64_t time_ns) noexcept;

  const Catalog& catalog_;
  const SetPartition& partition_;
  std::vector<Stay> sets_, objects_;
  SetMask active_;
  ObjectMask running_;
  bool demanded_ = false;
  std::int64_t next_ns_ = 0;
  std::array<double, max_control_sets> left_s_{};
};

}  // namespace kadans
