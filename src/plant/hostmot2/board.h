// One board in the loop: what a tick reads and writes of its modules, by instance and pin.
//
// Outputs that this robot uses are set to "not active" before anything drives them. The watchdog is set to its time
// when the board is set up, and petted by each tick; when it has bitten, the board's outputs are no outputs any more
// until repair() sets all of the board's registers again.
//
// One owner: open() before the loop, the rest in the control thread; nothing there allocates or throws.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "board_link.h"
#include "modules.h"
#include "settings.h"

namespace kadans::hostmot2 {

class Board {
 public:
  Board(BoardSettings settings, std::unique_ptr<BoardLink> link);

  // Finds the modules, checks what this robot wants of them, sets everything up but watchdog and outputs: these follow
  // with the first repair(). Throws InputError with the place in the configuration.
  void open(const HostMot2Settings& all);
  void close() noexcept;  // lets the watchdog bite at once

  // A tick: what the board read when it was sent the last one. False: nothing new came.
  bool collect() noexcept;
  void send() noexcept;
  std::int64_t time_ns() const noexcept { return sample_.time_ns; }  // of what it read
  bool bitten() const noexcept { return bitten_; }
  bool forgot() const noexcept { return forgot_; }
  std::uint32_t missed() const noexcept { return missed_; }  // ticks in a row without anything new
  // Sets all registers again, and the watchdog's bite back. Outputs follow what the next send() says.
  void repair() noexcept;

  // What it read.
  std::uint32_t encoder(unsigned instance) const noexcept { return in_[counts_at_ + instance]; }
  std::uint16_t latched(unsigned instance) const noexcept {
    return static_cast<std::uint16_t>(in_[latches_at_ + instance] >> 16U);
  }
  // Whether the latch that was armed still waits, for all that is known.
  bool latch_waits(unsigned instance) const noexcept {
    return latch_asked_ || (in_[latches_at_ + instance] & (latch_on_probe | latch_on_index)) != 0;
  }
  std::uint32_t stamp_clock() const noexcept { return in_[clock_at_]; }
  double stamps_per_s() const noexcept { return stamps_per_s_; }
  bool active(const PinSettings& pin) const noexcept {
    const std::uint32_t word = in_[pins_at_ + pin.number / modules_.port_width];
    return ((word >> (pin.number % modules_.port_width) & 1U) != 0) != pin.low;
  }

  // What it is to write.
  void set_active(const PinSettings& pin, bool active) noexcept;
  void set_duty(unsigned instance, double duty) noexcept;  // -1..1; anything else is 0
  void arm_latch(unsigned instance, bool for_probe) noexcept;
  void disarm_latch(unsigned instance) noexcept;

  const BoardLink& link() const noexcept { return *link_; }

 private:
  static constexpr std::uint32_t latch_on_index = 1U << 4U, just_once = 1U << 6U, filter = 1U << 11U,
                                 latch_on_probe = 1U << 13U, index_high = 1U << 3U, probe_high = 1U << 12U;

  [[noreturn]] void fail(const InputProblem& place, const std::string& why) const;
  void check_wiring(const HostMot2Settings& all) const;
  void lay_out();
  void list_set_up(const HostMot2Settings& all);
  void write_latch(unsigned instance, std::uint32_t control) noexcept;

  BoardSettings settings_;
  std::unique_ptr<BoardLink> link_;
  Modules modules_;
  double stamps_per_s_ = 1;
  std::vector<unsigned> pwm_bits_;  // of each
  std::vector<RegisterWrite> set_up_;
  std::size_t armed_from_ = 0;  // from here on the watchdog counts, and pins become outputs
  std::vector<std::uint32_t> in_, fresh_, out_;
  std::size_t status_at_ = 0, pins_at_ = 0, counts_at_ = 0, latches_at_ = 0, clock_at_ = 0;
  std::size_t out_pins_at_ = 0, out_pwm_at_ = 0, out_led_at_ = 0, usual_words_ = 0;
  bool latch_asked_ = false;                            // the latches are written too, until the board has heard of it
  std::uint32_t latch_number_ = 0, repair_number_ = 0;  // of the ticks that did so first
  std::uint32_t ticks_ = 0, missed_ = 0;
  bool bitten_ = false, forgot_ = false;
  BoardLink::Sample sample_;
};

}  // namespace kadans::hostmot2
