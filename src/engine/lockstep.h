// Virtual time on one thread: the world's time leads, everything else follows in a fixed order, so that the same seed
// gives the same run bit for bit. One step is one control period: the control ticks of all robots, their behavior ticks
// when they are due, their supervisors when they are due, then the world.
#pragma once

#include <cstdint>
#include <vector>

#include "behavior_engine.h"
#include "clock.h"
#include "engine/tick/control_engine.h"
#include "engine/tick/tick_statistics.h"
#include "kadans/plant/world.h"
#include "supervising.h"

namespace kadans {

class Lockstep {
 public:
  // The engines of the first robot, and what decides over its behaviors, if anything does. Keeps references. Throws
  // std::invalid_argument unless the behavior period is a whole multiple of the control period.
  Lockstep(const EngineSettings& settings, World& world, ControlEngine& control, BehaviorEngine& behaviors,
           Supervising* supervisor = nullptr);

  // Before the first step: the engines of another robot. The first robot's tick last, so that its signals can show
  // those of the others. Keeps references. Throws std::invalid_argument also when its control period is not that of the
  // first.
  void add(const EngineSettings& settings, ControlEngine& control, BehaviorEngine& behaviors,
           Supervising* supervisor = nullptr);

  // Throws what the world's step throws.
  void step();

  // Faults for tests and scenarios. miss: skips this number of control ticks of all robots before the next one.
  // silence: no tick of what is silent comes until it is called without it.
  void miss(std::uint32_t control_ticks) noexcept { missed_ = control_ticks; }
  struct Silent {
    bool behaviors = false, supervisor = false;
  };
  void silence(const BehaviorEngine& of, Silent silent) noexcept;

  std::int64_t time_ns() const noexcept { return clock_.now_ns(); }
  std::int64_t control_period_ns() const noexcept { return control_period_ns_; }
  const Clock& clock() const noexcept { return clock_; }
  const TickStatistics& control_tick_cost() const noexcept { return control_tick_cost_; }  // in wall time

 private:
  struct Engines {
    ControlEngine* control;
    BehaviorEngine* behaviors;
    Supervising* supervisor;  // nullptr: there is none
    std::int64_t behavior_period_ns;
    std::int64_t behaviors_due_ns = 0, supervisor_due_ns = 0;
    Silent silent{};
  };

  void pass_period();

  World& world_;
  std::vector<Engines> robots_;  // the first robot is the last
  VirtualClock clock_;
  WallClock wall_;
  TickStatistics control_tick_cost_;
  std::int64_t control_period_ns_;
  std::uint32_t missed_ = 0;
};

}  // namespace kadans
