// All buses of a robot with the servos that its configuration names, and the model that these servos move.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "emulated_bus.h"
#include "kadans/plant/plant_type.h"
#include "plant/drive_shafts.h"
#include "plant/dynamixel/settings.h"

namespace kadans::dynamixel {

class EmulatedRobot {
 public:
  // The servos are as they come from their box, but for id and baud rate.
  EmulatedRobot(const DynamixelSettings& settings, const PlantSite& site, std::uint64_t seed);

  std::size_t bus_count() const noexcept { return buses_.size(); }
  EmulatedBus& bus(std::size_t number) noexcept { return *buses_[number]; }
  // The servo of the drive in this joint's place.
  EmulatedServo& servo(std::size_t joint) noexcept;

  // The servos stand where the robot's joints are.
  void look(WorldRobot& robot);
  // The robot's drives do what the servos do.
  void drive(WorldRobot& robot);
  // Time passes for the servos.
  void pass(std::int64_t dt_ns) noexcept;
  void switch_power() noexcept;  // off and on again
  const std::vector<std::unique_ptr<EmulatedBus>>& buses() const noexcept { return buses_; }
  bool any_torque() const noexcept;
  bool any_watchdog_tripped() const noexcept;

 private:
  struct Wired {
    std::size_t bus, servo, joint;
  };
  DriveShafts shafts_;
  std::vector<std::unique_ptr<EmulatedBus>> buses_;
  std::vector<Wired> wired_;
};

}  // namespace kadans::dynamixel
