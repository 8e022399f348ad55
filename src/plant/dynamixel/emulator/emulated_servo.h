// A servo of the X series on its bus, as ROBOTIS' manual describes it. Nothing here is shared with the driver: what one
// of them has understood wrongly, the other one shows.
//
// One owner, one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "kadans/signal/frames.h"

namespace kadans::dynamixel {

class EmulatedServo {
 public:
  struct Settings {
    std::uint8_t id = 1;
    std::uint16_t model = 1030;
    std::uint8_t firmware = 46;
    std::uint8_t baud_code = 3;
    int zero_pulse = 2048;  // where it stands when its drive is at 0
    bool reversed = false;
    double Nm_per_A = 1;  // of its shaft
    double stall_Nm = 3, no_load_rad_s = 8;
  };
  enum Error : std::uint8_t {
    none = 0,
    failed = 1,
    instruction = 2,
    crc = 3,
    range = 4,
    length = 5,
    limit = 6,
    access = 7
  };

  explicit EmulatedServo(const Settings& settings);

  // The bus.
  std::uint8_t id() const noexcept { return table_[7]; }
  // By the code in its register, as the manual has them.
  static constexpr std::array<std::uint32_t, 8> rates{9600,      57'600,    115'200,   1'000'000,
                                                      2'000'000, 3'000'000, 4'000'000, 4'500'000};
  std::uint32_t baud() const noexcept;
  double return_delay_s() const noexcept { return 2e-6 * table_[9]; }
  std::uint8_t return_level() const noexcept { return table_[68]; }
  bool hears() const noexcept { return !unplugged_ && reboot_ns_ <= 0; }
  std::uint8_t alert() const noexcept { return table_[70] != 0 ? 0x80 : 0; }
  std::uint16_t model() const noexcept { return static_cast<std::uint16_t>(get(0, 2)); }
  std::uint8_t firmware() const noexcept { return table_[6]; }
  Error read(unsigned address, unsigned count, std::vector<std::uint8_t>& into) const;
  Error write(unsigned address, std::span<const std::uint8_t> bytes);
  void heard() noexcept { silent_ns_ = 0; }  // any instruction, to whomever
  void reboot() noexcept;
  void switch_power() noexcept { ram_defaults(); }  // off and on again, long enough ago
  void factory_reset(bool keep_id, bool keep_baud);

  // Its shaft. Positions and torques are the drive's, in the robot's coordinates.
  void stands(double position_rad, double velocity_rad_s, double effort_Nm, double supply_V) noexcept;
  void pass(std::int64_t dt_ns) noexcept;
  JointActuation drives() const noexcept;
  double current_A() const noexcept;
  bool torque() const noexcept { return table_[64] == 1; }
  bool tripped() const noexcept { return table_[98] == 0xFF; }

  // What may happen to it.
  void unplug(bool out) noexcept { unplugged_ = out; }
  void shift_zero(int pulses) noexcept { shift_ += pulses; }
  void heat_to(int celsius) noexcept { celsius_ = celsius; }
  void break_down(std::uint8_t hardware_error) noexcept;

 private:
  void defaults() noexcept;
  void ram_defaults() noexcept;
  bool has_current() const noexcept;
  unsigned slots() const noexcept;
  unsigned data_at() const noexcept;
  unsigned resolve(unsigned address) const noexcept;
  std::int64_t get(unsigned address, unsigned bytes) const noexcept;
  void set(unsigned address, unsigned bytes, std::int64_t value) noexcept;
  Error check(const std::array<bool, 700>& touched, const std::array<std::uint8_t, 700>& before) const;
  void after_write(const std::array<bool, 700>& touched, const std::array<std::uint8_t, 700>& before) noexcept;
  bool may_run_as(std::int64_t mode) const noexcept;
  void follow_mode() noexcept;
  double A_per_unit() const noexcept;

  Settings settings_;
  std::array<std::uint8_t, 700> table_{};
  double celsius_ = 30;
  std::int64_t silent_ns_ = 0, reboot_ns_ = 0, tick_ns_ = 0;
  double position_rad_ = 0, velocity_rad_s_ = 0, effort_Nm_ = 0;
  int shift_ = 0;
  bool unplugged_ = false;
};

}  // namespace kadans::dynamixel
