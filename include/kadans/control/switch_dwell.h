// The least time between two switches of a control set or a control object (`switch_dwell_s`): from its coming in to
// its leaving, and from its leaving to its coming in. Switching between stable controllers can be unstable when it is
// fast (Liberzon, Switching in Systems and Control, Birkhauser 2003, sec. 3.2: dwell time), and the fade of the switch
// before needs its time. A switch that comes too early is refused, not delayed. An object is switched when it starts or
// stops, in whatever sets; it goes on in a set that follows with the same object. The sets of the start do not dwell.
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
  // The set that must wait longest of those that the switch to `set` would switch. `active`: the sets before it; where
  // they are not as in the last note(), an earlier switch of the same tick changed them.
  Dweller against(SetMask active, std::uint32_t set, std::int64_t time_ns) const noexcept;
  void pass_state(auto& bytes) noexcept {
    for (Stay& stay : sets_) bytes(stay.until_ns);
    for (Stay& stay : objects_) bytes(stay.until_ns);
    bytes(active_, running_, next_ns_, left_s_);
    bytes.must(static_cast<std::size_t>(std::bit_width(active_)) <= sets_.size());
  }
  // For how long the object, or a set with it, will still dwell in the next tick.
  double left_s(std::uint32_t object) const noexcept;

 private:
  struct Stay {  // between two switches
    std::int64_t demanded_ns = 0, until_ns = 0;
  };
  static std::int64_t left_ns(const Stay& stay, bool changed, std::int64_t time_ns) noexcept;

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
