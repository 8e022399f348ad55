#include "servo.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kadans::dynamixel {
namespace {

constexpr std::int64_t reboot_ns = 500'000'000;
constexpr std::uint32_t strange_max = 3;       // readings of a servo that lost its settings
constexpr std::uint32_t wrong_torque_max = 5;  // readings
constexpr unsigned tries_max = 10;

constexpr std::int32_t wrapped(std::int32_t pulses) noexcept {
  const std::int32_t rest = ((pulses % pulses_per_turn) + pulses_per_turn) % pulses_per_turn;
  return rest >= pulses_per_turn / 2 ? rest - pulses_per_turn : rest;
}

std::uint8_t watchdog_units_of(double seconds) noexcept {
  return static_cast<std::uint8_t>(std::clamp(std::lround(std::ceil(seconds / watchdog_unit_s - 1e-9)), 1L, 127L));
}

}  // namespace

std::string_view drive_code_words(std::uint32_t code) noexcept {
  if (code == code_silent) return "does not answer";
  if (code == code_forgot) return "lost its settings, or its torque";
  if (code == code_refuses) return "refuses its settings";
  return hardware_error_words(code);
}

Servo::Servo(const ServoSettings& settings, std::size_t joint, double watchdog_s) noexcept
    : settings_(settings),
      joint_(joint),
      layout_(*settings.model),
      sign_(settings.reversed ? -1 : 1),
      watchdog_units_(watchdog_units_of(watchdog_s)) {
  Nm_per_unit_ = model().has_current() ? settings_.torque_constant_Nm_per_A() * model().A_per_unit
                                       : load_per_unit * model().stall_Nm;
}

void Servo::start_set_up() noexcept {
  stage_ = Stage::setting_up;
  step_ = tries_ = 0;
  mode_ = OperatingMode::unknown;
  missed_ = wrong_torque_ = strange_ = 0;
  goals_ = {};
  placed_ = read_in_mode_ = false;
}

Servo::SetUp Servo::set_up(ServoBus& bus) noexcept {
  std::uint32_t value = 0;
  // Registers of the EEPROM are written only where they differ: it wears out.
  const auto ensure = [&](Register which, std::uint32_t wanted) {
    const Answer answer = bus.read(id(), which, value);
    return answer != Answer::good || value == wanted ? answer : bus.write(id(), which, wanted);
  };
  const auto read_limit = [&](Register which, double& most) {
    const Answer answer = bus.read(id(), which, value);
    if (answer == Answer::good) most = static_cast<double>(value);
    return answer;
  };
  const auto write_layout = [&] {
    std::array<std::uint8_t, 2 * 28> bytes{};
    std::size_t slot = 0;
    for (const std::span<const Register> registers : {layout_.reads(), layout_.writes()}) {
      for (const Register& one : registers) {
        const Register shown = shown_for(model(), one);
        for (std::uint16_t k = 0; k < one.bytes; ++k, ++slot) {
          bytes[2 * slot] = static_cast<std::uint8_t>(shown.address + k);
          bytes[2 * slot + 1] = static_cast<std::uint8_t>((shown.address + k) >> 8U);
        }
      }
    }
    return bus.write_bytes(id(), indirect_address, {bytes.data(), 2 * slot});
  };
  const auto step = [&] {
    switch (step_) {
      case 0:
        return bus.write(id(), torque_enable, 0);
      case 1:
        return bus.write(id(), bus_watchdog, 0);
      case 2:
        return bus.write(id(), status_return_level, 2);
      case 3:
        return ensure(return_delay, 0);
      case 4:
        return ensure(drive_mode, 0);
      case 5:
        return write_layout();
      case 6:
        return bus.write(id(), profile_acceleration, 0);
      case 7:
        return bus.write(id(), profile_velocity, 0);
      case 8:
        return read_limit(pwm_limit, pwm_most_);
      case 9:
        return model().has_current() ? read_limit(current_limit, current_most_) : Answer::good;
      case 10:
        return read_limit(velocity_limit, velocity_most_);
      default:
        return bus.write(id(), bus_watchdog, watchdog_units_);
    }
  };
  const Answer answer = step();
  if (answer == Answer::good) {
    tries_ = 0;
    if (step_++ < 11) return SetUp::goes_on;
    stage_ = Stage::working;
    reading_.joint.code = 0;
    return SetUp::done;
  }
  if (++tries_ < tries_max) return SetUp::goes_on;
  give_up(answer == Answer::refused ? code_refuses : code_silent);
  return SetUp::failed;
}

void Servo::carry_out(DriveOrder order) noexcept {
  if (order == DriveOrder::enable) disabled_ = false;
  if (order == DriveOrder::disable) disabled_ = true;
  if (order != DriveOrder::reset) return;
  if (reading_.joint.code == 0) return;
  disabled_ = true;
  if (stage_ == Stage::working && reading_.joint.code < code_silent) {
    wants_reboot_ = true;
  } else {
    start_set_up();
  }
}

void Servo::rebooted(std::int64_t now_ns) noexcept {
  wants_reboot_ = false;
  stage_ = Stage::rebooting;
  reboot_over_ns_ = now_ns + reboot_ns;
  goals_ = {};
}

OperatingMode Servo::mode_for(ActuationMode mode) const noexcept {
  const bool current = model().has_current();
  switch (mode) {
    case ActuationMode::effort:
    case ActuationMode::impedance:
      return current ? OperatingMode::current : OperatingMode::pwm;
    case ActuationMode::position:
      return current ? OperatingMode::current_based_position : OperatingMode::extended_position;
    case ActuationMode::velocity:
      return OperatingMode::velocity;
    case ActuationMode::off:
      break;
  }
  return OperatingMode::unknown;
}

void Servo::plan(const JointActuation& asked, const DriveRequest& order, std::int64_t now_ns) noexcept {
  if (order.is_new(order_seen_)) carry_out(order.order);
  if (stage_ == Stage::rebooting && now_ns >= reboot_over_ns_) start_set_up();
  wants_mode_ = OperatingMode::unknown;
  goals_ = {.pwm = static_cast<std::int16_t>(pwm_most_), .position = raw_position_};
  const OperatingMode wanted = mode_for(asked.mode);
  const bool acts = stage_ == Stage::working && !disabled_ && reading_.joint.code == 0 && placed_ &&
                    wanted != OperatingMode::unknown && is_finite(asked);
  if (acts && wanted == mode_) {
    if (read_in_mode_) aim(asked);
  } else if (acts && !has_torque_) {
    wants_mode_ = wanted;  // else this cycle takes its torque first
  }
  tell_state();
}

template <typename T>
T Servo::limit(double value, double most) noexcept {
  if (!(std::abs(value) <= most)) ++limited_;
  return static_cast<T>(std::lround(std::clamp(value, -most, most)));
}

double Servo::effort_of(const JointActuation& asked) const noexcept {
  if (asked.mode == ActuationMode::effort) return asked.effort_Nm;
  return asked.stiffness_Nm_per_rad * (asked.position_rad - reading_.joint.position_rad) +
         asked.damping_Nms_per_rad * (asked.velocity_rad_s - reading_.velocity_rad_s) + asked.effort_Nm;
}

void Servo::aim(const JointActuation& asked) noexcept {
  goals_.torque = true;
  switch (mode_) {
    case OperatingMode::current:
      goals_.current = limit<std::int16_t>(sign_ * effort_of(asked) / Nm_per_unit_, current_most_);
      break;
    case OperatingMode::pwm: {  // what its motor's own voltage takes is added
      const double duty = effort_of(asked) / model().stall_Nm + reading_.velocity_rad_s / model().no_load_rad_s;
      goals_.pwm = limit<std::int16_t>(sign_ * duty * pwm_full, pwm_most_);
      break;
    }
    case OperatingMode::velocity:
      goals_.velocity = limit<std::int32_t>(sign_ * asked.velocity_rad_s / rad_s_per_unit, velocity_most_);
      break;
    default: {
      const double way = sign_ * (asked.position_rad - reading_.joint.position_rad) / rad_per_pulse;
      goals_.position = limit<std::int32_t>(raw_position_ + way, position_reach);
      goals_.current = static_cast<std::int16_t>(current_most_);
      break;
    }
  }
  // One without currents takes the PWM from both places.
  if (!model().has_current()) goals_.current = goals_.pwm;
}

bool Servo::take(Octets data, std::int64_t time_ns) noexcept {
  missed_ = 0;
  const auto at = [&](Register which) { return layout_.in_reads(which); };
  const std::uint8_t celsius = data[at(present_temperature)];
  const bool has_voltage = at(present_voltage) != IndirectLayout::nowhere;
  const std::uint16_t voltage = has_voltage ? u16_at(data, at(present_voltage)) : 0;
  const std::uint8_t torque = data[at(torque_enable)];
  // After a reboot the indirect addresses are gone, and what they show is 0.
  if (torque > 1 || (has_voltage ? voltage == 0 : celsius == 0)) {
    if (++strange_ >= strange_max) reading_.joint.code = code_forgot;
    return false;
  }
  strange_ = 0;
  has_torque_ = torque == 1;
  const auto raw = static_cast<std::int32_t>(u32_at(data, at(present_position)));
  turned_ =
      placed_ ? turned_ + wrapped(raw - raw_position_) : wrapped(raw - static_cast<std::int32_t>(settings_.zero_pulse));
  raw_position_ = raw;
  placed_ = read_in_mode_ = true;
  const double before_rad = reading_.joint.position_rad;
  const std::int64_t before_ns = reading_.joint.time_ns;
  reading_.joint.position_rad = reading_.joint.motor_position_rad = sign_ * turned_ * rad_per_pulse;
  if (at(present_velocity) != IndirectLayout::nowhere) {
    const auto units = static_cast<std::int32_t>(u32_at(data, at(present_velocity)));
    reading_.velocity_rad_s = sign_ * units * rad_s_per_unit;
  } else if (time_ns > before_ns && reading_.joint.sequence > 0) {
    reading_.velocity_rad_s = (reading_.joint.position_rad - before_rad) / seconds_between(before_ns, time_ns);
  }
  const auto current = static_cast<std::int16_t>(u16_at(data, at(present_current)));
  reading_.joint.motor_effort_Nm = sign_ * current * Nm_per_unit_;
  reading_.joint.temperature_C = celsius;
  if (has_voltage) reading_.supply_V = voltage * volt_per_unit;
  reading_.joint.time_ns = time_ns;
  ++reading_.joint.sequence;
  const std::uint8_t error = data[at(hardware_error)];
  if (error != 0) reading_.joint.code = error;
  wrong_torque_ = has_torque_ == goals_.torque || !goals_.torque ? 0 : wrong_torque_ + 1;
  if (wrong_torque_ >= wrong_torque_max && reading_.joint.code == 0) reading_.joint.code = code_forgot;
  tell_state();
  return true;
}

void Servo::give_up(std::uint32_t code) noexcept {
  stage_ = Stage::silent;
  reading_.joint.code = code;
  goals_ = {};
  tell_state();
}

void Servo::tell_state() noexcept {
  reading_.joint.drive = reading_.joint.code != 0       ? DriveState::fault
                         : disabled_                    ? DriveState::off
                         : stage_ != Stage::working     ? DriveState::off
                         : has_torque_ && goals_.torque ? DriveState::enabled
                                                        : DriveState::ready;
}

}  // namespace kadans::dynamixel
