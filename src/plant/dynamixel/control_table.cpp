#include "control_table.h"

#include <algorithm>

namespace kadans::dynamixel {
namespace {

constexpr double rpm(double per_minute) { return per_minute * 2 * std::numbers::pi / 60; }
constexpr double X = 0.00269, MX = 0.00336;  // A per unit

// clang-format off
constexpr std::array models{
    //          name           number  A/unit  Nm     A     rad/s
    ServoModel{"XM430-W350",   1020,   X,      4.1,   2.3,  rpm(46)},
    ServoModel{"XM430-W210",   1030,   X,      3.0,   2.3,  rpm(77)},
    ServoModel{"XM540-W270",   1120,   X,      10.6,  4.4,  rpm(30)},
    ServoModel{"XM540-W150",   1130,   X,      7.3,   4.4,  rpm(53)},
    ServoModel{"XH430-W350",   1000,   X,      3.4,   1.3,  rpm(30)},
    ServoModel{"XH430-W210",   1010,   X,      2.5,   1.3,  rpm(50)},
    ServoModel{"XH430-V210",   1050,   X,      2.6,   0.7,  rpm(52)},   // 24 V
    ServoModel{"XH540-W270",   1100,   X,      9.9,   4.9,  rpm(39)},   // E
    ServoModel{"XH540-W150",   1110,   X,      7.1,   4.9,  rpm(70)},   // E
    ServoModel{"XH540-V270",   1140,   X,      9.2,   2.4,  rpm(34)},   // 24 V
    ServoModel{"XH540-V150",   1150,   X,      6.4,   2.4,  rpm(60)},   // 24 V
    ServoModel{"XW540-T260",   1170,   X,      9.5,   4.9,  rpm(40)},
    ServoModel{"XW540-T140",   1180,   X,      6.9,   4.9,  rpm(72)},
    ServoModel{"XL430-W250",   1060,   0,      1.5,   1.4,  rpm(61)},
    ServoModel{"2XL430-W250",  1090,   0,      1.5,   1.4,  rpm(61)},
    ServoModel{"XC430-W240",   1080,   0,      1.9,   1.4,  rpm(70)},
    ServoModel{"XC430-W150",   1070,   0,      1.6,   1.4,  rpm(106)},  // E
    ServoModel{"XL330-M288",   1200,   0.001,  0.52,  1.47, rpm(103), 46, 6, 20, 208},  // 5 V; torque and speed E
    ServoModel{"XL330-M077",   1190,   0.001,  0.215, 1.47, rpm(383), 46, 6, 20, 208},  // 5 V; torque and speed E
    ServoModel{"MX-28",        30,     0,      2.5,   1.4,  rpm(55)},
    ServoModel{"MX-64",        311,    MX,     6.0,   4.1,  rpm(63)},
    ServoModel{"MX-106",       321,    MX,     8.4,   5.2,  rpm(45)},
};
// clang-format on

constexpr std::array full_reads{torque_enable,    hardware_error,  present_current,    present_velocity,
                                present_position, present_voltage, present_temperature};
constexpr std::array full_writes{goal_pwm, goal_current, goal_velocity, goal_position, torque_enable};
constexpr std::array small_reads{torque_enable, hardware_error, present_current, present_position, present_temperature};
constexpr std::array small_writes{goal_current, goal_velocity, goal_position, torque_enable};

constexpr std::size_t bytes_of(std::span<const Register> registers) {
  std::size_t bytes = 0;
  for (const Register& one : registers) bytes += one.bytes;
  return bytes;
}
static_assert(bytes_of(full_reads) + bytes_of(full_writes) == 28 &&
              bytes_of(small_reads) + bytes_of(small_writes) == 20);

}  // namespace

const ServoModel* find_model(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(models, name, &ServoModel::name);
  return found == models.end() ? nullptr : found;
}

const ServoModel* find_model(std::uint16_t number) noexcept {
  const auto* const found = std::ranges::find(models, number, &ServoModel::number);
  return found == models.end() ? nullptr : found;
}

std::vector<std::string> model_names() {
  std::vector<std::string> names;
  for (const ServoModel& model : models) names.emplace_back(model.name);
  return names;
}

std::uint32_t baud_of_code(std::uint32_t code) noexcept { return code < baud_rates.size() ? baud_rates[code] : 0; }

std::string unknown_baud(std::uint32_t baud) {
  std::string known;
  for (const std::uint32_t rate : baud_rates)
    known += (rate == baud_rates.front() ? ": " : rate == baud_rates.back() ? " or " : ", ") + std::to_string(rate);
  return "no servo knows " + std::to_string(baud) + " baud" + known;
}

IndirectLayout::IndirectLayout(const ServoModel& model) noexcept : data_(model.indirect_data) {
  const bool full = model.indirect_slots >= 28;
  reads_ = full ? std::span<const Register>(full_reads) : std::span<const Register>(small_reads);
  writes_ = full ? std::span<const Register>(full_writes) : std::span<const Register>(small_writes);
  read_bytes_ = bytes_of(reads_);
  write_bytes_ = bytes_of(writes_);
}

std::size_t IndirectLayout::offset(std::span<const Register> registers, Register wanted) noexcept {
  std::size_t at = 0;
  for (const Register& one : registers) {
    if (one == wanted) return at;
    at += one.bytes;
  }
  return nowhere;
}

// A servo without currents gets the PWM twice: in the current's place too.
Register shown_for(const ServoModel& model, Register wanted) noexcept {
  return wanted == goal_current && !model.has_current() ? goal_pwm : wanted;
}

}  // namespace kadans::dynamixel
