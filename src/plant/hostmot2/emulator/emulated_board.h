// The registers of a HostMot2 board and what its modules do with them, in time that the caller passes. Written from the
// facts about the firmware; nothing is shared with the driver, so what one of them has understood wrongly, the other
// one shows. (A PWM's value is looked at, not its edges: a pin's level is its mean over a period.)
//
// The firmware has encoders, PWM generators, LEDs and a watchdog: pins 0.. are the generators' (PWM, direction,
// /enable), then the encoders' (A, B, index), the rest are for anything.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace kadans::hostmot2 {

class EmulatedBoard {
 public:
  struct Settings {
    std::string name = "7I96";
    unsigned ports = 3, width = 17;
    unsigned encoders = 2, pwms = 2;
    unsigned counts_per_index = 4000;  // counts between two index pulses
  };

  // Throws std::invalid_argument when the pins do not suffice.
  explicit EmulatedBoard(const Settings& settings);

  const Settings& settings() const noexcept { return settings_; }

  // The bus: an aligned address. False: there is no such register, or it is not to be written.
  bool read(unsigned address, std::uint32_t& value) const noexcept;
  bool write(unsigned address, std::uint32_t value) noexcept;

  // The outside.
  void pass(std::int64_t dt_ns) noexcept;
  std::int64_t time_ns() const noexcept { return time_ns_; }
  void turn_to(unsigned encoder, std::int64_t count) noexcept;
  void probe(unsigned encoder, bool level) noexcept;  // the pin of its probe input
  void set_input(unsigned pin, bool level) noexcept { inputs_[pin] = level; }
  // The mean level of a pin, 0..1; one that nothing drives is 0.
  double level(unsigned pin) const noexcept;
  bool driven(unsigned pin) const noexcept;
  // Numbers of its pins.
  unsigned pwm_pin(unsigned pwm) const noexcept { return 3 * pwm; }  // and the two that follow
  unsigned first_free_pin() const noexcept { return 3 * (settings_.pwms + settings_.encoders); }
  unsigned pins() const noexcept { return settings_.ports * settings_.width; }

  void bite() noexcept;  // its watchdog does
  bool bitten() const noexcept { return bitten_; }
  bool watching() const noexcept { return (timeout_ & 0x80000000U) == 0 && !bitten_; }
  void switch_power() noexcept;  // off and on again: everything is as after its power came on
  // Its counter is what the outside counts.
  void restore_origin(unsigned encoder) noexcept { encoders_[encoder].origin = 0; }

 private:
  struct Encoder {
    std::int64_t count = 0;   // as the outside turned it
    std::int64_t origin = 0;  // where the register is 0
    std::uint16_t stamp = 0;  // of the last change
    std::uint32_t control = 0;
    std::uint16_t latched = 0;
    bool probe = false;
  };
  struct Pwm {
    std::uint32_t value = 0, mode = 0;
  };
  struct Port {
    std::uint32_t data = 0, direction = 0, secondary = 0, drain = 0, inverted = 0;
  };

  void power_on() noexcept;
  void write_idrom();
  std::uint16_t stamp_clock() const noexcept;
  void edge(Encoder& encoder, bool by_index) noexcept;
  double secondary_level(unsigned pin) const noexcept;
  double duty(const Pwm& pwm) const noexcept;
  std::uint32_t pin_word(unsigned port) const noexcept;
  bool index_at(std::int64_t count) const noexcept;

  Settings settings_;
  std::vector<std::uint32_t> idrom_;  // words from 0x400 on
  std::vector<Encoder> encoders_;
  std::vector<Pwm> pwms_;
  std::vector<Port> ports_;
  std::vector<bool> inputs_;
  std::uint32_t pwm_rate_ = 0, pdm_rate_ = 0, pwm_enable_ = 0;
  std::uint32_t stamp_divisor_ = 0, timeout_ = 0x80000000U;
  double left_ns_ = 0;  // until the watchdog bites
  bool bitten_ = false;
  std::int64_t time_ns_ = 0;
};

}  // namespace kadans::hostmot2
