// All boards of a robot, with what its configuration says is wired to them: encoders, amplifiers with their motors,
// brakes and switches, and the model that these move.
//
// The counters are as after a start at the jig: an encoder whose joint is homed by power_on is 0 where home_rad is. The
// others count from where the joint was when the power came on. An index or a probe lies at home_rad.
//
// One owner, one thread at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "emulated_board.h"
#include "emulated_wire.h"
#include "kadans/plant/drive_shafts.h"
#include "plant/drive_server.h"
#include "plant/hostmot2/settings.h"

namespace kadans::hostmot2 {

class EmulatedMachine final : public EmulatedDrives {
 public:
  // Each board has the encoders and PWMs that the configuration names. Throws InputError when its pins do not suffice.
  EmulatedMachine(const HostMot2Settings& settings, const PlantSite& site, std::uint64_t seed);

  EmulatedBoard& board(std::size_t number) noexcept { return boards_[number]; }
  EmulatedWire& wire(std::size_t number) noexcept { return wires_[number]; }
  const std::deque<EmulatedWire>& wires() const noexcept { return wires_; }

  void look(WorldRobot& robot) override;
  void drive(WorldRobot& robot) override;
  void pass(std::int64_t dt_ns) noexcept override;
  void switch_power() noexcept override;
  bool any_torque() const noexcept override;
  bool any_watchdog_tripped() const noexcept override;
  void check(const EmulatedFault& fault) const override;
  void befall(const EmulatedFault& fault, bool begins) noexcept override;
  bool enabled(std::size_t joint) const noexcept;  // its amplifier is

  // What may happen.
  void press_emergency(bool pressed) noexcept { emergency_.active = pressed; }
  void fail_amplifier(std::size_t joint, bool fails) noexcept;
  void block(std::size_t joint, double low_rad, double high_rad) noexcept;  // where its limit switches are
  void set_sensor(const std::string& name, bool active) noexcept;

 private:
  struct Wired {
    std::size_t board, joint;
    DriveWiring is;
    double low_rad = -1e9, high_rad = 1e9;
    bool fails = false;
  };
  struct Foot {
    std::size_t board, number;  // in the sensors
    FootWiring is;
  };
  struct Input {
    std::size_t board;
    InputWiring is;
    bool active = false;
  };
  void switch_power(std::size_t board) noexcept;
  double duty(const Wired& wired) const noexcept;
  bool output(std::size_t board, const OptionalPin& pin) const noexcept;
  void input(std::size_t board, const OptionalPin& pin, bool active) noexcept;
  Wired& at(std::size_t joint) noexcept;

  DriveShafts shafts_;
  std::vector<std::string> names_;  // of the boards
  std::deque<EmulatedBoard> boards_;
  std::deque<EmulatedWire> wires_;
  std::vector<Wired> wired_;
  std::vector<Foot> feet_;
  std::vector<Input> inputs_;
  Input emergency_;
  bool looked_ = false;
};

}  // namespace kadans::hostmot2
