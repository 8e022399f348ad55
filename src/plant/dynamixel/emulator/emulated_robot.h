// All buses of a robot with the servos that its configuration names, and the model that these servos move.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emulated_bus.h"
#include "kadans/plant/drive_shafts.h"
#include "kadans/plant/plant_type.h"
#include "plant/drive_server.h"
#include "plant/dynamixel/settings.h"

namespace kadans::dynamixel {

class EmulatedRobot final : public EmulatedDrives {
 public:
  // The servos are as they come from their box, but for id and baud rate.
  EmulatedRobot(const DynamixelSettings& settings, const PlantSite& site, std::uint64_t seed);

  EmulatedBus& bus(std::size_t number) noexcept { return *buses_[number]; }
  // The servo of the drive in this joint's place.
  EmulatedServo& servo(std::size_t joint) noexcept;

  const std::vector<std::unique_ptr<EmulatedBus>>& buses() const noexcept { return buses_; }

  void look(WorldRobot& robot) override;
  void drive(WorldRobot& robot) override;
  void pass(std::int64_t dt_ns) noexcept override;
  void switch_power() noexcept override;
  bool any_torque() const noexcept override;
  bool any_watchdog_tripped() const noexcept override;
  void check(const EmulatedFault& fault) const override;
  void befall(const EmulatedFault& fault, bool begins) noexcept override;

 private:
  bool hits(const EmulatedFault& fault, std::size_t bus) const noexcept {
    return fault.of.empty() || fault.of == ports_[bus];
  }
  struct Wired {
    std::size_t bus, servo, joint;
  };
  DriveShafts shafts_;
  std::vector<std::string> ports_;  // names
  std::vector<std::unique_ptr<EmulatedBus>> buses_;
  std::vector<Wired> wired_;
};

}  // namespace kadans::dynamixel
