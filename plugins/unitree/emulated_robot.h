// The electronics of an emulated robot: obeys commands as its motors do, tells its state, damps when it hears nothing,
// and can have faults. A model of a robot stands behind it.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "kadans/plant/drive_shafts.h"
#include "kadans/plant/emulated_drives.h"
#include "kadans/signal/random.h"
#include "settings.h"

namespace unitree {

class EmulatedRobot final : public kadans::EmulatedDrives {
 public:
  struct Counts {
    std::uint64_t commands = 0;  // that were obeyed
    std::uint64_t corrupt = 0;   // with a wrong checksum
    std::uint64_t foreign = 0;   // not of the low level, or for another machine
    std::uint64_t refused = 0;   // with numbers that no motor takes
    std::uint64_t states = 0;
  };

  // Throws InputError when the robot's drives and its motors do not fit.
  EmulatedRobot(const Settings& settings, const kadans::PlantSite& site);

  void look(kadans::WorldRobot& robot) override;
  void drive(kadans::WorldRobot& robot) override;
  void pass(std::int64_t dt_ns) noexcept override;
  void switch_power() noexcept override;
  bool any_torque() const noexcept override;
  bool any_watchdog_tripped() const noexcept override { return heard_ && silent_ns_ > watchdog_ns_; }
  void check(const kadans::EmulatedFault& fault) const override;
  void befall(const kadans::EmulatedFault& fault, bool begins) noexcept override;

  // True: it obeys.
  bool hear(const Packet& command) noexcept;
  // Its state as of the last look. False: it is lost on the way.
  bool tell(Packet& state) noexcept;
  // Whether a second writer of commands is about, by a fault; and what that writes: the motors damp.
  bool second_writer() const noexcept { return second_writer_; }
  void second_command(Packet& command) const noexcept;

  const Counts& counts() const noexcept { return counts_; }
  Family family() const noexcept { return family_; }

 private:
  bool takes(const MotorCommand& motor) const noexcept;

  std::vector<MotorSettings> motors_;
  Family family_;
  kadans::DriveShafts shafts_;
  std::array<std::size_t, 4> feet_;  // which foot stands where in foot_force
  double foot_N_per_count_, damping_Nms_per_rad_;
  std::int64_t watchdog_ns_;
  Command command_;
  State state_;
  std::vector<std::uint32_t> tripped_;  // codes, by joint
  std::vector<bool> not_finite_;
  kadans::RandomStream random_;
  double lost_ = 0, corrupt_ = 0, again_ = 0;
  bool cable_out_ = false, second_writer_ = false;
  std::int64_t clock_ns_ = 1'000'000'000, silent_ns_ = 0;
  bool heard_ = false;
  Counts counts_;
};

}  // namespace unitree
