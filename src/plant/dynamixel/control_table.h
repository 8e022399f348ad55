// The control table that the X series and the MX series with protocol 2.0 share, and the models with what is different
// in each, as data. From ROBOTIS' manual (emanual.robotis.com); E: an estimate, where the manual gives no figure.
//
// The registers that each cycle reads and writes lie far from each other. So each servo is told to show them side by
// side in its indirect data: first those that are read, then those that are written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kadans::dynamixel {

struct Register {
  std::uint16_t address;
  std::uint8_t bytes;
  bool operator==(const Register&) const = default;
};

// EEPROM: writable only while torque is off.
inline constexpr Register own_id{7, 1}, baud_rate{8, 1}, return_delay{9, 1}, drive_mode{10, 1}, operating_mode{11, 1},
    pwm_limit{36, 2}, current_limit{38, 2}, velocity_limit{44, 4};
// RAM.
inline constexpr Register torque_enable{64, 1}, status_return_level{68, 1}, hardware_error{70, 1}, bus_watchdog{98, 1},
    goal_pwm{100, 2}, goal_current{102, 2}, goal_velocity{104, 4}, profile_acceleration{108, 4},
    profile_velocity{112, 4}, goal_position{116, 4}, present_current{126, 2}, present_velocity{128, 4},
    present_position{132, 4}, present_voltage{144, 2}, present_temperature{146, 1};
inline constexpr std::uint16_t indirect_address = 168;  // of slot 1, 2 bytes each

enum class OperatingMode : std::uint8_t {
  current = 0,
  velocity = 1,
  position = 3,
  extended_position = 4,
  current_based_position = 5,
  pwm = 16,
  unknown = 255
};

inline constexpr int pulses_per_turn = 4096;
inline constexpr double rad_per_pulse = 2 * std::numbers::pi / pulses_per_turn;
inline constexpr double rad_s_per_unit = 0.229 * 2 * std::numbers::pi / 60;  // of velocities
inline constexpr int pwm_full = 885;                                         // 100 %
inline constexpr int position_reach = 1'048'575;                             // of goal positions beyond one turn
inline constexpr double volt_per_unit = 0.1, load_per_unit = 0.001, watchdog_unit_s = 0.02, return_delay_unit_s = 2e-6;

struct ServoModel {
  std::string_view name;
  std::uint16_t number;
  double A_per_unit;                 // of its currents; 0: it measures none, and shows its load instead
  double stall_Nm, stall_A;          // at its nominal voltage
  double no_load_rad_s;              // at the same
  std::uint8_t fast_read_from = 45;  // firmware that knows fast sync read
  std::uint8_t baud_code_max = 7;    // 4.5 MBd
  std::uint8_t indirect_slots = 28;
  std::uint16_t indirect_data = 224;  // address of slot 1's data

  bool has_current() const noexcept { return A_per_unit > 0; }
  double Nm_per_A() const noexcept { return stall_Nm / stall_A; }
};

const ServoModel* find_model(std::string_view name) noexcept;
const ServoModel* find_model(std::uint16_t number) noexcept;
std::vector<std::string> model_names();

// Of register Baud Rate by its code, 0..7; 0 for others.
std::uint32_t baud_of_code(std::uint32_t code) noexcept;
inline constexpr std::array<std::uint32_t, 8> baud_rates{9600,      57'600,    115'200,   1'000'000,
                                                         2'000'000, 3'000'000, 4'000'000, 4'500'000};

std::string unknown_baud(std::uint32_t baud);  // a sentence: no servo has it, and which there are

// What a cycle reads of each servo and writes to it, through its indirect data.
class IndirectLayout {
 public:
  explicit IndirectLayout(const ServoModel& model) noexcept;

  std::span<const Register> reads() const noexcept { return reads_; }
  std::span<const Register> writes() const noexcept { return writes_; }
  std::size_t read_bytes() const noexcept { return read_bytes_; }
  std::size_t write_bytes() const noexcept { return write_bytes_; }
  std::uint16_t read_address() const noexcept { return data_; }
  std::uint16_t write_address() const noexcept { return static_cast<std::uint16_t>(data_ + read_bytes_); }
  static constexpr std::size_t nowhere = 255;
  // Where the register stands in what is read; `nowhere` when it does not.
  std::size_t in_reads(Register wanted) const noexcept { return offset(reads_, wanted); }
  // Servos on one port are read and written together, so all have one layout.
  bool operator==(const IndirectLayout& other) const noexcept {
    return data_ == other.data_ && read_bytes_ == other.read_bytes_;
  }

 private:
  static std::size_t offset(std::span<const Register> registers, Register wanted) noexcept;

  std::span<const Register> reads_, writes_;
  std::size_t read_bytes_ = 0, write_bytes_ = 0;
  std::uint16_t data_;
};

// The address that the model shows in place of a register that it does not have; the value is that register's.
Register shown_for(const ServoModel& model, Register wanted) noexcept;

}  // namespace kadans::dynamixel
