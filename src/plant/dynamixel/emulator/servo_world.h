// A model that is driven through servos, on virtual time (wired_world.h). A cycle of the bus takes as long as its bytes
// do, and what it read is seen when it is over.
#pragma once

#include <memory>
#include <vector>

#include "emulated_robot.h"
#include "kadans/plant/wired_world.h"
#include "plant/dynamixel/dynamixel_plant.h"

namespace kadans::dynamixel {

class VirtualPort final : public SerialPort {
 public:
  VirtualPort(EmulatedBus& bus, std::uint32_t baud) : bus_(bus), baud_(baud) {}
  bool send(Octets bytes) noexcept override;
  std::size_t receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept override;
  void discard() noexcept override;
  std::int64_t now_ns() const noexcept override { return now_; }
  void set(std::int64_t now) noexcept { now_ = now; }
  std::uint64_t passed() const noexcept { return passed_.value(); }

  std::size_t sent = 0, received = 0;  // bytes
  std::size_t twice = 0;               // so many bytes at the begin of what comes come twice

 private:
  EmulatedBus& bus_;
  std::uint32_t baud_;
  std::int64_t now_ = -1'000'000'000'000;
  WireHash passed_;
};

class ServoWorld final : public WiredWorld {
 public:
  // `there`: what the servos are, where that is not what the driver's configuration says. Throws InputError.
  ServoWorld(std::unique_ptr<World> model, const DynamixelSettings& settings, const PlantSite& site,
             const DynamixelSettings* there = nullptr);

  DynamixelPlant& driver() noexcept { return *plant_; }
  EmulatedRobot& servos() noexcept { return servos_; }
  VirtualPort& port(std::size_t number) noexcept { return *ports_[number]; }
  std::int64_t cycle_ns = 0;  // what the last cycle took

 private:
  Plant& plant() const noexcept override { return *plant_; }
  EmulatedDrives& drives() noexcept override { return servos_; }
  void set_time(std::int64_t now_ns) noexcept override;
  bool open_driver(bool (*give_up)() noexcept) override;
  void take(SensorFrame& sensors) noexcept override;
  void begin_step() override;
  void end_step() override {}
  std::uint64_t passed() const noexcept override;

  EmulatedRobot servos_;
  std::vector<VirtualPort*> ports_;
  std::unique_ptr<DynamixelPlant> plant_;
  SensorFrame held_;
  std::int64_t next_ns_ = 0, visible_ns_ = 0;
};

}  // namespace kadans::dynamixel
