// Virtual time on one thread: the world's time leads, everything else follows in a fixed order, so that the same seed
// gives the same run bit for bit. One step is one control period: the control tick, the behavior tick when it is due,
// then the world.
#pragma once

#include <cstdint>

#include "behavior_engine.h"
#include "clock.h"
#include "engine/tick/control_engine.h"
#include "engine/tick/tick_statistics.h"
#include "kadans/plant/world.h"

namespace kadans {

class Lockstep {
 public:
  // Keeps references. Throws std::invalid_argument unless the behavior period is a whole multiple of the control
  // period.
  Lockstep(const EngineSettings& settings, World& world, ControlEngine& control, BehaviorEngine& behaviors);

  // Throws what the world's step throws.
  void step();

  // Faults for tests and scenarios. miss: skips this number of control ticks before the next one. silence_behaviors: no
  // behavior tick comes until it is called with false.
  void miss(std::uint32_t control_ticks) noexcept { missed_ = control_ticks; }
  void silence_behaviors(bool silent) noexcept { behaviors_silent_ = silent; }

  std::int64_t time_ns() const noexcept { return clock_.now_ns(); }
  std::int64_t control_period_ns() const noexcept { return control_period_ns_; }
  const Clock& clock() const noexcept { return clock_; }
  const TickStatistics& control_tick_cost() const noexcept { return control_tick_cost_; }  // in wall time

 private:
  void pass_period();

  World& world_;
  ControlEngine& control_;
  BehaviorEngine& behaviors_;
  VirtualClock clock_;
  WallClock wall_;
  TickStatistics control_tick_cost_;
  std::int64_t control_period_ns_;
  std::int64_t behavior_period_ns_;
  std::int64_t behaviors_due_ns_ = 0;
  std::uint32_t missed_ = 0;
  bool behaviors_silent_ = false;
};

}  // namespace kadans
