#include "kadans/signal/fault.h"

#include <algorithm>
#include <array>

#include "kadans/signal/status.h"
#include "number_text.h"

namespace kadans {
namespace {

struct CodeText {
  FaultCode code;
  const char* name;
  const char* key;
};

using enum FaultCode;
constexpr std::array<CodeText, fault_codes> texts{{
    {none, "none", ""},
    {position_limit, "position_limit", "safety.position_margin_rad"},
    {velocity_limit, "velocity_limit", "safety.velocity_margin"},
    {effort_limit, "effort_limit", "safety.limits.effort_max_Nm"},
    {actuation_not_finite, "actuation_not_finite", "safety.reactions"},
    {sensor_not_finite, "sensor_not_finite", "safety.reactions"},
    {sensor_silent, "sensor_silent", "safety.silent_ticks_max"},
    {heartbeat_lost, "heartbeat_lost", "safety.heartbeat_timeout_s"},
    {tick_overrun, "tick_overrun", "engine.control_period_s"},
    {command_refused, "command_refused", "safety.reactions"},
    {soft_stop, "soft_stop", "safety.soft_stop.zone_rad"},
    {soft_speed, "soft_speed", "safety.limits.velocity_max_rad_s"},
    {effort_rate_limit, "effort_rate_limit", "safety.limits.effort_rate_max_Nm_s"},
    {power_limit, "power_limit", "safety.limits.power_max_W"},
    {motor_warm, "motor_warm", "safety.thermal.warm_C"},
    {motor_hot, "motor_hot", "safety.thermal.hot_C"},
    {sensor_stuck, "sensor_stuck", "safety.sensors.stuck_ticks"},
    {sensor_jump, "sensor_jump", "safety.sensors.jump_rad"},
    {imu_silent, "imu_silent", "safety.silent_ticks_max"},
    {imu_stuck, "imu_stuck", "safety.sensors.imu_stuck_ticks"},
    {imu_jump, "imu_jump", "safety.sensors.gyro_step_rad_s"},
    {imu_not_finite, "imu_not_finite", "safety.reactions"},
    {foot_silent, "foot_silent", "safety.silent_ticks_max"},
    {foot_stuck, "foot_stuck", "safety.sensors.foot_stuck_ticks"},
    {foot_jump, "foot_jump", "safety.sensors.foot_force_max_N"},
    {foot_not_finite, "foot_not_finite", "safety.reactions"},
    {tilt, "tilt", "safety.tilt_max_rad"},
    {fall, "fall", "safety.fall.pitch_max_rad"},
    {impact, "impact", "safety.fall.impact_max_m_s2"},
    {command_old, "command_old", "engine.command_age_max_s"},
    {overruns, "overruns", "safety.overruns_in_a_row_max"},
    {joints_lost, "joints_lost", "safety.joints_lost_max"},
    {emergency_stop, "emergency_stop", ""},
    {drive_fault, "drive_fault", "safety.reactions"},
    {drive_not_enabled, "drive_not_enabled", "safety.drives.enable_s"},
    {drive_hot, "drive_hot", "safety.drives.hot_C"},
    {sample_old, "sample_old", "safety.drives.sample_age_max_s"},
    {supply_low, "supply_low", "safety.supply.lowest_V"},
    {supply_high, "supply_high", "safety.supply.highest_V"},
    {emergency_input, "emergency_input", ""},
    {channel_silent, "channel_silent", "safety.silent_ticks_max"},
    {channel_range, "channel_range", "sensors"},
    {channel_not_finite, "channel_not_finite", "safety.reactions"},
    {modes_differ, "modes_differ", "safety.reactions"},
}};

constexpr bool in_order() {
  for (std::size_t i = 0; i < texts.size(); ++i) {
    if (static_cast<std::size_t>(texts[i].code) != i) return false;
  }
  return true;
}
static_assert(in_order());

// Of an enumeration's value that may have come from anywhere.
template <std::size_t count>
const char* named(const std::array<const char*, count>& names, std::size_t value) noexcept {
  return value < count ? names[value] : "unknown";
}

}  // namespace

const char* name(FaultCode code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return index < texts.size() ? texts[index].name : "unknown";
}

const char* configuration_key(FaultCode code) noexcept {
  const auto index = static_cast<std::size_t>(code);
  return index < texts.size() ? texts[index].key : "";
}

FaultWords fault_words(std::string_view text) noexcept {
  FaultWords words{};
  std::copy_n(text.begin(), std::min(text.size(), words.size() - 1), words.begin());
  return words;
}

ToldFault told(const Fault& fault, const std::string& joint, std::int64_t time_ns, const std::string& robot) {
  const std::string of = robot.empty() || joint.empty() ? robot + joint : robot + "." + joint;
  return {name(fault.code), of, fault.value, fault.limit, fault.words.data(), time_ns};
}

std::string fault_name(const ToldFault& fault) {
  return fault.name + (fault.joint.empty() ? "" : " of " + fault.joint);
}

std::string fault_detail(const ToldFault& fault) {
  return fault.words.empty() ? printed("%g, limit %g", fault.value, fault.limit) : fault.words;
}

std::string fault_text(const ToldFault& fault) { return fault_name(fault) + ": " + fault_detail(fault); }

const char* name(ActuationMode mode) noexcept {
  return named(std::array{"off", "effort", "position", "velocity", "impedance"}, static_cast<std::size_t>(mode));
}

const char* name(DriveState state) noexcept {
  return named(std::array{"off", "ready", "enabled", "homing", "fault"}, static_cast<std::size_t>(state));
}

const char* name(DriveOrder order) noexcept {
  return named(std::array{"none", "enable", "disable", "reset", "home", "brake", "release"},
               static_cast<std::size_t>(order));
}

const char* name(Posture posture) noexcept {
  return named<posture_count>({"upright", "prone", "supine", "left", "right", "falling"},
                              static_cast<std::size_t>(posture));
}

const char* name(SeenSource source) noexcept {
  return named<seen_sources>({"none", "scenario", "perception", "message", "record"}, static_cast<std::size_t>(source));
}

const char* name(SafetyLevel level) noexcept {
  return named<safety_levels>({"normal", "limited", "hold", "damp", "off"}, static_cast<std::size_t>(level));
}

}  // namespace kadans
