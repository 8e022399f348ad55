// The two engines, and a world, as periodic tasks.
#pragma once

#include <atomic>
#include <cstdint>

#include "engine/behavior_engine.h"
#include "engine/tick/control_engine.h"
#include "kadans/exchange/latest.h"
#include "kadans/plant/world.h"
#include "task_thread.h"

namespace kadans {

// The two engines as periodic tasks.

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

// A world on a thread of its own, and what the control thread sees of it.
//
// The world's thread steps the world once a period and publishes the sensors. The control thread reads the newest
// sample and publishes its actuation; the model holds it until its next step, as a drive would. Both use storages that
// never block. These are position independent, so the model may also be in another process.
struct PlantExchange {
  Latest<SensorFrame> sensors;       // written by the model's thread
  Latest<PlantTruth> truth;          // the same
  Latest<ActuationFrame> actuation;  // written by the control thread
};

// The control thread's end.
class LinkedPlant final : public Plant, public TruthSource {
 public:
  // The first robot of the world, as it is before the threads start.
  LinkedPlant(PlantExchange& exchange, World& world);

  void read(SensorFrame& sensors) noexcept override {
    const auto newest = exchange_.sensors.read();
    copy_used(*newest, sensors);
  }
  void write(const ActuationFrame& actuation) noexcept override { exchange_.actuation.publish(actuation); }
  const PlantTruth& truth() const noexcept override;  // control thread

 private:
  PlantExchange& exchange_;
  mutable PlantTruth truth_;  // as last asked for
};

// The model's end. When its thread comes late, it makes up for the periods that it missed, but for a few at most. The
// rest of the time does not pass for the model, and is counted.
class PlantTask final : public Task {
 public:
  PlantTask(PlantExchange& exchange, World& world, std::int64_t period_ns) noexcept
      : exchange_(exchange), world_(world), period_ns_(period_ns) {}

  bool beat(const Beat& beat) override;  // throws what the world's step throws
  std::uint64_t lost_periods() const noexcept { return lost_periods_.get(); }

 private:
  static constexpr std::uint32_t catch_up_max = 10;

  PlantExchange& exchange_;
  World& world_;
  std::int64_t period_ns_;
  Count lost_periods_;
  SensorFrame sensors_;
};

}  // namespace kadans
