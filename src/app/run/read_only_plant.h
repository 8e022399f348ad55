// A plant that is only read: whatever the engine asks, its drives are asked for nothing, and no order reaches them.
//
// Control thread in the tick; the rest as of the plant behind it.
#pragma once

#include "kadans/plant/plant.h"

namespace kadans {

class ReadOnlyPlant final : public Plant {
 public:
  explicit ReadOnlyPlant(Plant& plant) : plant_(plant) {}  // keeps a reference

  void declare_signals(SignalTable& table) const override { plant_.declare_signals(table); }
  bool open(bool (*give_up)() noexcept) override { return plant_.open(give_up); }
  void close() noexcept override { plant_.close(); }
  std::vector<PlantCount> link_counts() const override { return plant_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override { plant_.read(sensors); }
  void write(const ActuationFrame& actuation) noexcept override {
    nothing_.joint_count = actuation.joint_count;
    plant_.write(nothing_);
  }

 private:
  Plant& plant_;
  ActuationFrame nothing_;
};

}  // namespace kadans
