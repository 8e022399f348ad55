// The two engines as periodic tasks.
#pragma once

#include <atomic>
#include <cstdint>

#include "engine/behavior_engine.h"
#include "engine/tick/control_engine.h"
#include "task_thread.h"

namespace kadans {

// Other work that has to be done on an engine's thread.
class BesideTick {
 public:
  virtual ~BesideTick() = default;
  virtual void beside_tick(std::int64_t time_ns) = 0;
};

// One control tick per beat. From the wake-up to the publishing there is no system call but the plant's. Work beside
// the tick comes after it.
class ControlTask final : public Task {
 public:
  explicit ControlTask(ControlEngine& engine, BesideTick* after = nullptr) noexcept : engine_(engine), after_(after) {}

  bool beat(const Beat& beat) override;
  void prepare() noexcept override;

  std::uint64_t ticks() const noexcept { return ticks_.get(); }
  const TickStatistics& tick_cost() const noexcept { return cost_; }  // of the engine's tick alone, in wall time

 private:
  ControlEngine& engine_;
  BesideTick* after_;
  WallClock wall_;
  Count ticks_;
  TickStatistics cost_;
};

// One behavior tick per beat. Work beside the tick comes before it.
class BehaviorTask final : public Task {
 public:
  explicit BehaviorTask(BehaviorEngine& engine, BesideTick* before = nullptr) noexcept
      : engine_(engine), before_(before) {}

  bool beat(const Beat& beat) override;  // throws what the high level of a control object throws
  void prepare() noexcept override { engine_.prepare(); }

 private:
  BehaviorEngine& engine_;
  BesideTick* before_;
};

}  // namespace kadans
