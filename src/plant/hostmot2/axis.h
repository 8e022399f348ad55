// One drive: its encoder, its amplifier's PWM, its pins; what is asked of it and what is wrong with it.
//
// The amplifier gets a current, a voltage or a velocity; effort is what follows from the motor's constants
// (amplifier.h). The loops of position, velocity and impedance are closed here, in each control tick, with the
// encoder's own velocity.
//
// One owner, the control thread; nothing allocates or throws.
#pragma once

#include <cstdint>
#include <string_view>

#include "board.h"
#include "encoder.h"
#include "kadans/signal/frames.h"

namespace kadans::hostmot2 {

// Codes of the frames.
inline constexpr std::uint32_t code_watchdog = 1, code_silent = 2, code_forgot = 4, code_amplifier = 8,
                               code_strange = 16, code_no_zero = 32;
std::string_view drive_code_words(std::uint32_t code) noexcept;

class Axis {
 public:
  Axis(const DriveWiring& wiring, Board& board, std::size_t joint) noexcept;

  std::size_t joint() const noexcept { return joint_; }
  // What the board read last; `fresh`: it is new in this tick.
  void take(bool fresh, std::uint32_t silent_ticks_max) noexcept;
  // What the board is to write: carries out a new order, does what is asked. True: the board needs a repair().
  bool plan(const JointActuation& asked, const DriveRequest& order, double period_s) noexcept;
  // As the frames have it, in the drive's coordinate.
  const JointSample& sample() const noexcept { return sample_; }
  std::uint32_t limited() const noexcept { return limited_; }
  std::uint32_t strange() const noexcept { return strange_readings_; }

 private:
  enum class Brake : std::uint8_t { by_itself, closed, open };

  bool carry_out(DriveOrder order) noexcept;
  void seek(double period_s) noexcept;
  void found(std::int64_t count) noexcept;
  bool plausible() noexcept;
  double effort_of(const JointActuation& asked) const noexcept;
  void tell_state(bool acts) noexcept;
  double position_of(std::int64_t count) const noexcept {
    return wiring_.home_rad + sign_ * static_cast<double>(count - zero_count_) / wiring_.counts_per_rad;
  }

  DriveWiring wiring_;
  Board& board_;
  std::size_t joint_;
  Encoder encoder_;
  Amplifier amplifier_;
  double sign_;
  JointSample sample_;
  double velocity_rad_s_ = 0;
  std::int64_t zero_count_ = 0, last_count_ = 0, last_ns_ = 0;
  bool disabled_ = false, seeking_ = false, was_at_switch_ = false, placed_ = false;
  double sought_s_ = 0;
  Brake brake_ = Brake::by_itself;
  std::uint8_t order_seen_ = 0;
  std::uint32_t code_ = 0, limited_ = 0, strange_ = 0, strange_readings_ = 0;
};

}  // namespace kadans::hostmot2
