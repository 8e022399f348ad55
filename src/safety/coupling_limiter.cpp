#include "coupling_limiter.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace kadans {
namespace {

constexpr int digits = 3;
constexpr std::size_t name_length_max = 16;

double or_none(double limit) { return limit > 0 ? limit : std::numeric_limits<double>::infinity(); }

}  // namespace

CouplingLimiter::CouplingLimiter(const SafetySettings& settings, const Transmission& transmission)
    : transmission_(transmission), velocity_margin_(settings.velocity_margin) {
  for (std::size_t i = 0; i < 2; ++i) {
    const JointLimits& limits = settings.joints[joint(i)];
    effort_max_Nm_[i] = or_none(limits.drive_effort_max_Nm);
    velocity_max_rad_s_[i] = or_none(limits.drive_velocity_max_rad_s);
    const std::string name = transmission.drives().empty() ? std::to_string(i + 1) : transmission.drives()[i];
    names_[i] = fault_words("drive " + name.substr(0, name_length_max) + ": ");
  }
}

FaultMask CouplingLimiter::limit(const JointStates& joints, ActuationFrame& actuation) noexcept {
  JointActuation &first = actuation.joints[joint(0)], &second = actuation.joints[joint(1)];
  const auto effort_Nm = transmission_.drive_effort_Nm({first.effort_Nm, second.effort_Nm});
  const auto velocity_rad_s = transmission_.drive_velocity_rad_s(
      {joints.joints[joint(0)].velocity_rad_s, joints.joints[joint(1)].velocity_rad_s});
  cut_ = {};
  for (std::size_t i = 0; i < 2; ++i) {
    const double asked_Nm = std::abs(effort_Nm[i]), most_Nm = effort_max_Nm_[i];
    if (asked_Nm > most_Nm) consider({most_Nm / asked_Nm, FaultCode::effort_limit, i, effort_Nm[i], most_Nm});
    const double speed_rad_s = std::abs(velocity_rad_s[i]), limit_rad_s = velocity_max_rad_s_[i];
    if (!(speed_rad_s > limit_rad_s) || effort_Nm[i] * velocity_rad_s[i] <= 0 || most_Nm > 1e9) continue;
    const double fade_rad_s = std::max(1e-6, (velocity_margin_ - 1) * limit_rad_s);
    const double left_Nm = most_Nm * std::max(0.0, 1 - (speed_rad_s - limit_rad_s) / fade_rad_s);
    if (asked_Nm > left_Nm) consider({left_Nm / asked_Nm, FaultCode::soft_speed, i, velocity_rad_s[i], limit_rad_s});
  }
  const double effort_share = cut_.share;
  const bool by_drive = first.mode > ActuationMode::effort && second.mode == first.mode;
  double speed_share = 1;
  if (by_drive) {
    const auto asked_rad_s = transmission_.drive_velocity_rad_s({first.velocity_rad_s, second.velocity_rad_s});
    for (std::size_t i = 0; i < 2; ++i) {
      const double speed_rad_s = std::abs(asked_rad_s[i]), limit_rad_s = velocity_max_rad_s_[i];
      if (!(speed_rad_s > limit_rad_s)) continue;
      speed_share = std::min(speed_share, limit_rad_s / speed_rad_s);
      consider({limit_rad_s / speed_rad_s, FaultCode::soft_speed, i, asked_rad_s[i], limit_rad_s});
    }
  }
  for (JointActuation* each : {&first, &second}) {
    if (effort_share < 1) each->effort_Nm *= effort_share;
    if (speed_share < 1) each->velocity_rad_s *= speed_share;
  }
  return cut_.code == FaultCode::none ? 0 : bit(cut_.code);
}

// "drive left: 12.3, limit 11.5"
void CouplingLimiter::describe(Fault& fault) const noexcept {
  if (fault.code != cut_.code) return;
  tell(fault, cut_.value, cut_.limit);
  fault.words = names_[cut_.drive];
  char* const end = fault.words.data() + fault.words.size() - 1;
  char* at = std::find(fault.words.data(), end, '\0');
  const auto add = [&](double number) { at = std::to_chars(at, end, number, std::chars_format::general, digits).ptr; };
  const auto put = [&](std::string_view text) {
    at = std::copy_n(text.begin(), std::min(text.size(), static_cast<std::size_t>(end - at)), at);
  };
  add(cut_.value);
  put(", limit ");
  add(cut_.limit);
}

}  // namespace kadans
