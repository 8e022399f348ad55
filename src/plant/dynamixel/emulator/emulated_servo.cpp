#include "emulated_servo.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kadans/plant/drive_shafts.h"

namespace kadans::dynamixel {
namespace {

constexpr double turn_rad = 6.283185307179586, a_turn = 4096;
constexpr double rad_s = 0.229 * turn_rad / 60;
constexpr double ambient_C = 25;
constexpr std::int64_t boot_ns = 300'000'000, watchdog_ns = 20'000'000;
enum : std::int64_t {
  by_current = 0,
  by_velocity = 1,
  one_turn = 3,
  many_turns = 4,
  current_position = 5,
  by_pwm = 16
};

// The registers that may be written: address, bytes, least, most. A 0 as the most: another rule says it.
struct Entry {
  unsigned address, bytes;
  std::int64_t least, most;
};
constexpr std::array written{
    Entry{7, 1, 0, 252},        Entry{8, 1, 0, 7},       Entry{9, 1, 0, 254},      Entry{10, 1, 0, 13},
    Entry{11, 1, 0, 16},        Entry{12, 1, 0, 255},    Entry{13, 1, 2, 2},       Entry{20, 4, -1044479, 1044479},
    Entry{24, 4, 0, 1023},      Entry{31, 1, 0, 100},    Entry{32, 2, 31, 300},    Entry{34, 2, 31, 300},
    Entry{36, 2, 0, 885},       Entry{38, 2, 0, 2047},   Entry{44, 4, 0, 2047},    Entry{48, 4, 0, 4095},
    Entry{52, 4, 0, 4095},      Entry{60, 1, 0, 3},      Entry{63, 1, 0, 63},      Entry{64, 1, 0, 1},
    Entry{65, 1, 0, 1},         Entry{68, 1, 0, 2},      Entry{76, 2, 0, 16383},   Entry{78, 2, 0, 16383},
    Entry{80, 2, 0, 16383},     Entry{82, 2, 0, 16383},  Entry{84, 2, 0, 16383},   Entry{88, 2, 0, 16383},
    Entry{90, 2, 0, 16383},     Entry{98, 1, 0, 127},    Entry{100, 2, -885, 885}, Entry{102, 2, -2047, 2047},
    Entry{104, 4, -2047, 2047}, Entry{108, 4, 0, 32767}, Entry{112, 4, 0, 32767},  Entry{116, 4, -1048575, 1048575},
};

}  // namespace

EmulatedServo::EmulatedServo(const Settings& settings) : settings_(settings) { defaults(); }

std::uint32_t EmulatedServo::baud() const noexcept { return table_[8] < rates.size() ? rates[table_[8]] : 0; }

bool EmulatedServo::has_current() const noexcept {
  const std::uint16_t number = settings_.model;
  return number != 1060 && number != 1070 && number != 1080 && number != 1090 && number != 30;
}

unsigned EmulatedServo::slots() const noexcept { return settings_.model == 1190 || settings_.model == 1200 ? 20 : 28; }
unsigned EmulatedServo::data_at() const noexcept { return slots() == 20 ? 208 : 224; }

double EmulatedServo::A_per_unit() const noexcept {
  if (slots() == 20) return 0.001;
  return settings_.model == 311 || settings_.model == 321 ? 0.00336 : 0.00269;
}

std::int64_t EmulatedServo::get(unsigned address, unsigned bytes) const noexcept {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < bytes; ++i) value |= std::uint32_t{table_[address + i]} << (8 * i);
  if (bytes == 2) return static_cast<std::int16_t>(value);
  return bytes == 4 ? std::int64_t{static_cast<std::int32_t>(value)} : std::int64_t{value};
}

void EmulatedServo::set(unsigned address, unsigned bytes, std::int64_t value) noexcept {
  for (unsigned i = 0; i < bytes; ++i) table_[address + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void EmulatedServo::defaults() noexcept {
  table_.fill(0);
  set(0, 2, settings_.model);
  table_[6] = settings_.firmware;
  table_[7] = settings_.id;
  table_[8] = settings_.baud_code;
  table_[9] = 250;
  table_[11] = one_turn;
  table_[12] = 255;
  table_[13] = 2;
  set(24, 4, 10);
  table_[31] = 80;
  set(32, 2, 160);
  set(34, 2, 95);
  set(36, 2, 885);
  set(38, 2, slots() == 20 ? 1750 : settings_.model == 1120 || settings_.model == 1130 ? 2047 : 1193);
  set(44, 4, 1023);
  set(48, 4, 4095);
  table_[63] = 52;
  ram_defaults();
}

void EmulatedServo::ram_defaults() noexcept {
  std::fill(table_.begin() + 64, table_.end(), std::uint8_t{0});
  table_[68] = 2;
  set(76, 2, 1920);
  set(78, 2, 100);
  set(84, 2, 800);
  for (unsigned slot = 0; slot < slots(); ++slot) set(168 + 2 * slot, 2, data_at() + slot);
  follow_mode();
  silent_ns_ = 0;
}

// Goals and gains as they are when the operating mode was changed.
void EmulatedServo::follow_mode() noexcept {
  set(100, 2, get(36, 2));
  set(102, 2, has_current() ? get(38, 2) : 0);
  if (table_[11] == by_current) set(102, 2, 0);
  if (table_[11] == by_pwm) set(100, 2, 0);
  set(104, 4, 0);
  set(108, 4, 0);
  set(112, 4, 0);
  set(116, 4, get(132, 4));
}

unsigned EmulatedServo::resolve(unsigned address) const noexcept {
  if (address < data_at() || address >= data_at() + slots()) return address;
  const auto shown = static_cast<unsigned>(get(168 + 2 * (address - data_at()), 2)) & 0xFFFFU;
  return shown < table_.size() ? shown : address;
}

EmulatedServo::Error EmulatedServo::read(unsigned address, unsigned count, std::vector<std::uint8_t>& into) const {
  if (count == 0 || address + count > table_.size()) return Error::range;
  for (unsigned i = 0; i < count; ++i) into.push_back(table_[resolve(address + i)]);
  return Error::none;
}

EmulatedServo::Error EmulatedServo::write(unsigned address, std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || address + bytes.size() > table_.size()) return Error::range;
  const std::array<std::uint8_t, 700> before = table_;
  std::array<bool, 700> touched{};
  for (unsigned i = 0; i < bytes.size(); ++i) {
    const unsigned at = resolve(address + i);
    table_[at] = bytes[i];
    touched[at] = true;
  }
  const Error error = check(touched, before);
  if (error != Error::none) {
    table_ = before;
    return error;
  }
  after_write(touched, before);
  return Error::none;
}

bool EmulatedServo::may_run_as(std::int64_t mode) const noexcept {
  if (mode == by_current || mode == current_position) return has_current();
  return mode == by_velocity || mode == one_turn || mode == many_turns || mode == by_pwm;
}

EmulatedServo::Error EmulatedServo::check(const std::array<bool, 700>& touched,
                                          const std::array<std::uint8_t, 700>& before) const {
  const bool torque = before[64] == 1, tripped = before[98] == 0xFF;
  for (unsigned at = 0; at < touched.size(); ++at) {
    if (!touched[at]) continue;
    const bool indirect = (at >= 168 && at < 168 + 2 * slots()) || (at >= data_at() && at < data_at() + slots());
    const auto* const entry = std::ranges::find_if(
        written, [&](const Entry& one) { return at >= one.address && at < one.address + one.bytes; });
    if (indirect) {
      if (at < data_at() && torque) return Error::access;
      const unsigned slot_at = 168 + 2 * ((at - 168) / 2);
      if (at < 168 + 2 * slots() && (get(slot_at, 2) < 64 || get(slot_at, 2) > 661)) return Error::range;
      continue;
    }
    if (entry == written.end() || (!has_current() && entry->address == 102)) return Error::access;
    if (at < 64 && torque) return Error::access;
    std::int64_t value = get(entry->address, entry->bytes);
    if (value < entry->least || value > entry->most) return Error::range;
    if (entry->address == 11 && !may_run_as(value)) return Error::range;
    if (entry->address >= 100 && entry->address <= 116 && tripped) return Error::range;
    if (entry->address == 64 && value == 1 && (table_[70] & table_[63]) != 0) return Error::failed;
    if ((entry->address == 100 && std::abs(value) > get(36, 2)) ||
        (entry->address == 102 && std::abs(value) > get(38, 2)) ||
        (entry->address == 104 && std::abs(value) > get(44, 4)))
      return Error::limit;
    if (entry->address == 116 && table_[11] == one_turn && (value < get(52, 4) || value > get(48, 4)))
      return Error::limit;
  }
  return Error::none;
}

void EmulatedServo::after_write(const std::array<bool, 700>& touched,
                                const std::array<std::uint8_t, 700>& before) noexcept {
  if (touched[11] && table_[11] != before[11]) follow_mode();
  if (touched[64] && table_[64] == 1 && before[64] == 0) set(116, 4, get(132, 4));
  if (touched[98]) silent_ns_ = 0;
}

void EmulatedServo::reboot() noexcept {
  ram_defaults();
  celsius_ = std::min(celsius_, 60.0);
  reboot_ns_ = boot_ns;
}

void EmulatedServo::factory_reset(bool keep_id, bool keep_baud) {
  const std::uint8_t old_id = table_[7], old_baud = table_[8];
  defaults();
  table_[7] = keep_id ? old_id : 1;
  table_[8] = keep_baud ? old_baud : 1;
  reboot_ns_ = boot_ns;
}

void EmulatedServo::break_down(std::uint8_t error) noexcept {
  table_[70] |= error;
  if ((table_[70] & table_[63]) != 0) table_[64] = 0;
}

double EmulatedServo::current_A() const noexcept { return std::abs(effort_Nm_) / settings_.Nm_per_A; }

void EmulatedServo::stands(double position_rad, double velocity_rad_s, double effort_Nm, double supply_V) noexcept {
  const double sign = settings_.reversed ? -1 : 1;
  position_rad_ = position_rad;
  velocity_rad_s_ = velocity_rad_s;
  effort_Nm_ = effort_Nm;
  std::int64_t raw = settings_.zero_pulse + shift_ + std::llround(sign * position_rad / turn_rad * a_turn);
  if (table_[11] == one_turn || table_[11] == by_current || table_[11] == by_pwm) raw = ((raw % 4096) + 4096) % 4096;
  set(132, 4, raw + get(20, 4));
  set(128, 4, std::llround(sign * velocity_rad_s / rad_s));
  const double shown =
      has_current() ? effort_Nm / settings_.Nm_per_A / A_per_unit() : 1000 * effort_Nm / settings_.stall_Nm;
  set(126, 2, std::llround(std::clamp(sign * shown, -32767.0, 32767.0)));
  set(124, 2, std::llround(std::clamp(885 * sign * effort_Nm / settings_.stall_Nm, -885.0, 885.0)));
  set(144, 2, std::llround(10 * supply_V));
  set(146, 1, std::clamp<std::int64_t>(std::llround(celsius_), 0, 255));
}

void EmulatedServo::pass(std::int64_t dt_ns) noexcept {
  reboot_ns_ = std::max<std::int64_t>(0, reboot_ns_ - dt_ns);
  tick_ns_ += dt_ns;
  set(120, 2, tick_ns_ / 1'000'000 % 32768);
  const double dt_s = 1e-9 * static_cast<double>(dt_ns);
  celsius_ += dt_s * (0.5 * current_A() * current_A() - (celsius_ - ambient_C) / 300);
  if (celsius_ > table_[31]) break_down(0x04);
  silent_ns_ += dt_ns;
  const bool watches = table_[64] == 1 && table_[98] > 0 && table_[98] < 0xFF;
  if (!watches || silent_ns_ < table_[98] * watchdog_ns) return;
  table_[98] = 0xFF;  // it stops where it is, and takes no goals until somebody clears this
  set(104, 4, 0);
  set(108, 4, 0);
  set(112, 4, 0);
  set(116, 4, get(132, 4));
  if (table_[11] == by_pwm) set(100, 2, 0);
  if (table_[11] == by_current) set(102, 2, 0);
}

JointActuation EmulatedServo::drives() const noexcept {
  if (table_[64] != 1 || reboot_ns_ > 0) return {};
  const double sign = settings_.reversed ? -1 : 1;
  switch (table_[11]) {
    case by_current:
      return {.effort_Nm = sign * static_cast<double>(get(102, 2)) * A_per_unit() * settings_.Nm_per_A,
              .mode = ActuationMode::effort};
    case by_velocity:
      return {.velocity_rad_s = sign * static_cast<double>(get(104, 4)) * rad_s, .mode = ActuationMode::velocity};
    case by_pwm:
      return motor_at_voltage(sign * static_cast<double>(get(100, 2)) / 885, settings_.stall_Nm,
                              settings_.no_load_rad_s);
    default: {
      const double way = static_cast<double>(get(116, 4) - get(132, 4)) / a_turn * turn_rad;
      return {.position_rad = position_rad_ + sign * way, .mode = ActuationMode::position};
    }
  }
}

}  // namespace kadans::dynamixel
