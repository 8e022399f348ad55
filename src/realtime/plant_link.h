// A world on a thread of its own, and what the control thread sees of it.
//
// The world's thread steps the world once a period and publishes the sensors. The control thread reads the newest
// sample and publishes its actuation; the model holds it until its next step, as a drive would. Both use storages that
// never block. These are position independent, so the model may also be in another process.
#pragma once

#include <cstdint>

#include "kadans/exchange/latest.h"
#include "kadans/plant/world.h"
#include "task_thread.h"

namespace kadans {

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
