// A world of one robot with an IMU on a serial line beside whatever drives it, on virtual time.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "emulated_imu.h"
#include "kadans/plant/plant_type.h"
#include "kadans/plant/wired_world.h"
#include "plant/imu/imu_plant.h"
#include "plant/serial/serial_port.h"

namespace kadans::imu {

// A serial line with an emulated IMU at its other end.
class ImuLine final : public SerialPort {
 public:
  explicit ImuLine(EmulatedImu& device) : device_(device) {}
  bool send(std::span<const std::uint8_t> bytes) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void discard() noexcept override {}
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::uint64_t passed() const noexcept { return passed_.value(); }
  // The device has measured until now; its bytes come with the next receive().
  void fetch();

 private:
  EmulatedImu& device_;
  std::int64_t now_ = 1'000'000;
  std::array<std::uint8_t, 900> ready_{};
  std::size_t fetched_ = 0;
  WireHash passed_;
};

class ImuWorld : public WorldAround {
 public:
  // The device measures what the IMU in `robot`'s frames does; `to_base` turns its axes into the base's. Throws
  // std::invalid_argument for faults that it cannot have; they are by this world's time.
  ImuWorld(std::unique_ptr<World> robot, const SerialImuSettings& settings, const Quat& to_base,
           const std::vector<EmulatedFault>& faults = {}, std::uint64_t seed = 1);

  // As the robot's own. Without it the first read does so.
  bool open(bool (*give_up)() noexcept = nullptr) override;
  void declare_signals(SignalTable& table) const override { plant_->declare_signals(table); }
  std::vector<PlantCount> link_counts() const override { return plant_->link_counts(); }
  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override { plant_->write(actuation); }
  void step(std::int64_t dt_ns) override;
  void hash(StateHash& hash) const noexcept override;

  EmulatedImu& device() noexcept { return device_; }

 private:
  // The robot's own drives, as a plant; what it reads is also what the device feels.
  class Beside;

  void feel(const SensorFrame& sensors) noexcept;

  std::vector<EmulatedFault> faults_;
  Quat to_base_;
  EmulatedImu device_;
  ImuLine* line_;
  std::unique_ptr<ImuPlant> plant_;
  std::int64_t time_ns_ = 0;
  bool started_ = false;
};

}  // namespace kadans::imu
