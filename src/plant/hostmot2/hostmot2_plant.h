// A robot of joints on HostMot2 boards: encoders, PWM generators and pins, on one board or several.
//
// The control thread does it all, with one datagram to each board and one back in a tick. `read` takes what a board
// read when it got the last tick's datagram; each joint has that time. `write` sends the actuation, and asks for the
// next readings. So a reading is one control period old, and an actuation is not delayed. A bus that is slower than the
// control is written in the tick before each whole multiple of its period: in that one a reading is one tick old.
//
// Safe state: a board's watchdog makes all of its pins inputs when no datagram came for watchdog_s. Amplifiers are
// disabled then, and brakes hold. close() lets it bite at once.
#pragma once

#include <memory>
#include <vector>

#include "axis.h"
#include "board.h"
#include "kadans/plant/plant_type.h"

namespace kadans::hostmot2 {

class HostMot2Plant final : public Plant {
 public:
  // The ways to the boards, in their order.
  HostMot2Plant(HostMot2Settings settings, PlantSite site, std::vector<std::unique_ptr<BoardLink>> links);
  ~HostMot2Plant() override;  // closes

  bool open(bool (*give_up)() noexcept = nullptr) override;
  void close() noexcept override;
  void declare_signals(SignalTable& table) const override;
  std::vector<PlantCount> link_counts() const override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;

 private:
  struct Pin {
    std::size_t board = 0;
    OptionalPin pin{};
    bool active(const std::vector<Board>& boards) const noexcept { return pin && boards[board].active(*pin); }
  };
  struct Foot {
    std::size_t number = 0, board = 0;
    std::array<Pin, sensors_per_foot> corners{};
    double closed_N = 0;
  };
  struct Input {
    std::size_t number = 0;
    Pin pin;
  };
  struct Wired {
    std::size_t board;
    Axis axis;
  };

  std::size_t place_in(const std::vector<std::string>& names, const std::string& name, const char* what) const;
  void wire();

  HostMot2Settings settings_;
  PlantSite site_;
  std::vector<Board> boards_;
  std::vector<bool> fresh_;
  std::vector<bool> repair_;
  std::vector<Wired> axes_;
  std::vector<Foot> feet_;
  std::vector<Input> inputs_;
  Pin emergency_;
  bool open_ = false, driven_ = false;
  std::uint32_t divisor_ = 1, tick_ = 0;  // the boards are asked in every so many ticks
  bool asked_ = true;                     // in the last one
  std::uint32_t silent_ticks_max_ = 5;
  ActuationFrame drives_;
  LinkCounts counts_;
  std::uint32_t limited_ = 0, strange_ = 0, bites_ = 0;
  double age_ms_ = 0;
};

}  // namespace kadans::hostmot2
