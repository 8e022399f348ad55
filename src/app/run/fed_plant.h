// Stands for a plant in a run that repeats a record: it has its signals, and its sensors are those of the record.
// Nothing hears its actuation, unless the run goes on in a model.
#pragma once

#include <memory>
#include <utility>

#include "kadans/plant/plant.h"
#include "realtime/engine_tasks.h"

namespace kadans {

class FedPlant final : public Plant {
 public:
  FedPlant(std::unique_ptr<Plant> plant, PlantExchange& record) : plant_(std::move(plant)), record_(record) {}

  void declare_signals(SignalTable& table) const override { plant_->declare_signals(table); }
  void read(SensorFrame& sensors) noexcept override {
    const auto newest = record_.sensors.read();
    copy_used(*newest, sensors);
  }
  void write(const ActuationFrame& actuation) noexcept override { record_.actuation.publish(actuation); }

 private:
  std::unique_ptr<Plant> plant_;  // never open
  PlantExchange& record_;
};

}  // namespace kadans
