// A model that is driven through the low level, on virtual time (kadans/plant/wired_world.h): the driver, the messages
// word by word, and the emulated robot. DDS alone is left out.
#pragma once

#include <memory>

#include "emulated_robot.h"
#include "kadans/plant/wired_world.h"
#include "unitree_plant.h"

namespace unitree {

// The wire: what is written is there at once.
class VirtualLink final : public DriverLink {
 public:
  explicit VirtualLink(EmulatedRobot& robot) : robot_(robot) {}
  bool send(const Packet& command) noexcept override;
  bool take(Packet& state) noexcept override;
  std::uint32_t foreign_commands() noexcept override { return std::exchange(foreign_, 0); }
  void wait(std::int64_t until_ns) noexcept override { now_ns_ = std::max(now_ns_, until_ns); }
  std::int64_t now_ns() const noexcept override { return now_ns_; }

  void set_time(std::int64_t now_ns) noexcept { now_ns_ = now_ns; }
  void exchange() noexcept;  // the robot tells its state, and a second writer writes
  std::uint64_t passed() const noexcept { return passed_.value(); }

 private:
  void pass(const Packet& packet) noexcept;

  EmulatedRobot& robot_;
  Packet state_, second_;
  bool waits_ = false;
  std::uint32_t foreign_ = 0;
  std::int64_t now_ns_ = 0;
  kadans::StateHash passed_;
};

class UnitreeWorld final : public kadans::WiredWorld {
 public:
  // Throws InputError.
  UnitreeWorld(std::unique_ptr<kadans::World> model, const Settings& settings, const kadans::PlantSite& site);

  void close() noexcept override { plant_->close(); }
  EmulatedRobot& electronics() noexcept { return robot_; }

 private:
  kadans::Plant& plant() const noexcept override { return *plant_; }
  kadans::EmulatedDrives& drives() noexcept override { return robot_; }
  void set_time(std::int64_t now_ns) noexcept override { link_->set_time(now_ns); }
  bool open_driver(bool (*give_up)() noexcept) override;
  void take(kadans::SensorFrame& sensors) noexcept override;
  void begin_step() override;
  void end_step() override {}
  std::uint64_t passed() const noexcept override { return link_->passed(); }

  EmulatedRobot robot_;
  VirtualLink* link_;  // of plant_
  std::unique_ptr<UnitreePlant> plant_;
  std::int64_t period_ns_, next_ns_ = 0;
  kadans::SensorFrame measured_;
};

}  // namespace unitree
