
#include "joint_watch.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace kadans {
namespace {

constexpr double continuous_share_default = 0.6;

double first_not_finite(const JointActuation& a) noexcept {
  if (!std::isfinite(a.effort_Nm)) return a.effort_Nm;
  if (!std::isfinite(a.position_rad)) return a.position_rad;
  if (!std::isfinite(a.velocity_rad_s)) return a.velocity_rad_s;
  return std::isfinite(a.stiffness_Nm_per_rad) ? a.damping_Nms_per_rad : a.stiffness_Nm_per_rad;
}

}  // namespace

JointWatch::JointWatch(const SafetySettings& settings, const JointLimits& limits) noexcept
    : lowest_rad_(limits.lower_rad - settings.position_margin_rad),
      highest_rad_(limits.upper_rad + settings.position_margin_rad),
      fastest_rad_s_(limits.velocity_max_rad_s * settings.velocity_margin),
      jump_rad_(settings.sensors.jump_rad),
      jump_rad_s_(2 * limits.velocity_max_rad_s),
      stuck_motion_rad_(settings.sensors.stuck_motion_rad),
      stuck_effort_Nm_(settings.sensors.stuck_effort_share * limits.effort_max_Nm),
      compliance_{.own_rad_per_Nm = limits.spring_Nm_per_rad > 0 ? 1 / limits.spring_Nm_per_rad : 0},
      warm_C_(settings.thermal.warm_C),
      hot_C_(settings.thermal.hot_C),
      lower_rad_(limits.lower_rad),
      upper_rad_(limits.upper_rad),
      stuck_ticks_(settings.sensors.stuck_ticks),
      silent_ticks_max_(settings.silent_ticks_max),
      passive_(limits.effort_max_Nm == 0) {
  if (passive_) return;
  const double wanted_Nm =
      limits.continuous_Nm > 0 ? limits.continuous_Nm : continuous_share_default * limits.effort_max_Nm;
  const double continuous_Nm = std::min(wanted_Nm, limits.effort_max_Nm);
  continuous_share_ = continuous_Nm / limits.effort_max_Nm;
  thermal_ = ThermalModel(settings.thermal, continuous_Nm, limits.thermal_time_constant_s);
}

FaultMask JointWatch::derate() noexcept {
  const double temperature_C = thermal_.temperature_C();
  const double heat = std::min(1.0, (temperature_C - warm_C_) / std::max(hot_C_ - warm_C_, 1e-6));
  derating_ = 1 - heat * (1 - continuous_share_);
  return bit(temperature_C >= hot_C_ ? FaultCode::motor_hot : FaultCode::motor_warm);
}

void JointWatch::describe(const Input& in, Fault& fault) const noexcept {
  using enum FaultCode;
  switch (fault.code) {
    case position_limit:
      return tell(fault, in.state.position_rad, in.state.position_rad < lower_rad_ ? lower_rad_ : upper_rad_);
    case velocity_limit:
      return tell(fault, in.state.velocity_rad_s, fastest_rad_s_);
    case actuation_not_finite:
      fault.value = first_not_finite(in.asked);
      break;
    case sensor_not_finite:
      fault.value = in.sample.position_rad;
      break;
    case sensor_silent:
      return tell(fault, in.health.silent_ticks, silent_ticks_max_ + in.health.period_ticks - 1);
    case sensor_stuck:
      return tell(fault, same_, stuck_ticks_);
    case sensor_jump:
      return tell(fault, step_rad_, step_max_rad_);
    case motor_warm:
    case motor_hot:
      return tell(fault, thermal_.temperature_C(), fault.code == motor_warm ? warm_C_ : hot_C_);
    default:
      break;
  }
}

namespace {

// The number to look up, and what the maker calls it: "code 18: undervoltage".
FaultWords words_of(std::uint32_t code, DriveWords words) noexcept {
  FaultWords text = fault_words("code ");
  char* const end = text.data() + text.size() - 1;
  char* at = std::to_chars(text.data() + 5, end, code).ptr;
  const auto add = [&](std::string_view more) {
    at = std::copy_n(more.begin(), std::min(more.size(), static_cast<std::size_t>(end - at)), at);
  };
  const std::string_view said = words == nullptr ? std::string_view() : words(code);
  if (!said.empty()) add(": ");
  add(said);
  return text;
}

}  // namespace

void DriveWatch::describe(const SafetySettings& settings, const Input& in, Fault& fault) const noexcept {
  switch (fault.code) {
    case FaultCode::drive_fault:
      fault.value = in.sample.code;
      fault.words = words_of(in.sample.code, settings.drive_words);
      break;
    case FaultCode::drive_not_enabled:
      tell(fault, idle_s_, settings.drives.enable_s);
      fault.words = fault_words(name(in.sample.drive));
      break;
    case FaultCode::drive_hot:
      return tell(fault, static_cast<double>(in.sample.temperature_C), settings.drives.hot_C);
    case FaultCode::sample_old:
      return tell(fault, age_s(in), settings.drives.sample_age_max_s);
    default:
      break;
  }
}

FaultMask SupplyWatch::look(const SensorFrame& sensors, double dt_s) noexcept {
  using enum FaultCode;
  supply_V_ = sensors.supply_V;
  // One that is not told any more may be empty.
  const bool low = settings_.lowest_V > 0 && !(supply_V_ >= settings_.lowest_V);
  const bool high = settings_.highest_V > 0 && supply_V_ > settings_.highest_V;
  low_s_ = low ? low_s_ + dt_s : 0;
  high_s_ = high ? high_s_ + dt_s : 0;
  return bit_if(low && low_s_ > settings_.time_s, supply_low) |
         bit_if(high && high_s_ > settings_.time_s, supply_high) | bit_if(sensors.emergency, emergency_input);
}

void SupplyWatch::describe(Fault& fault) const noexcept {
  if (fault.code == FaultCode::supply_low) {
    tell(fault, supply_V_, settings_.lowest_V);
  } else if (fault.code == FaultCode::supply_high) {
    tell(fault, supply_V_, settings_.highest_V);
  } else if (fault.code == FaultCode::emergency_input) {
    fault.words = fault_words("the button");
  }
}

}  // namespace kadans
