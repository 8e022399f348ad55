#include "kadans/safety/safety.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

bool finite(const JointActuation& a) noexcept {
  return std::isfinite(a.effort_Nm) && std::isfinite(a.position_rad) && std::isfinite(a.velocity_rad_s);
}

void check_limits(const JointLimits& limits, const Joint& joint) {
  const bool sane = limits.lower_rad <= limits.upper_rad && limits.velocity_max_rad_s >= 0 && limits.effort_max_Nm >= 0;
  if (!sane) throw std::invalid_argument("safety limits of joint " + joint.name + " make no sense");
}

}  // namespace

Safety::Safety(const SafetySettings& settings, const RobotModel& model)
    : settings_(settings), joint_count_(model.joints.size()) {
  if (settings_.joints.size() != joint_count_) {
    throw std::invalid_argument("safety limits for " + std::to_string(settings_.joints.size()) + " joints, the robot has " +
                                std::to_string(joint_count_));
  }
  for (std::size_t i = 0; i < joint_count_; ++i) check_limits(settings_.joints[i], model.joints[i]);
}

void Safety::raise(const Fault& fault) noexcept {
  if (fault_count_++ == 0) first_fault_ = fault;
  (void)log_.try_push(fault);
}

void Safety::clear() noexcept {
  joint_levels_.fill(SafetyLevel::normal);
  robot_level_ = SafetyLevel::normal;
  heartbeat_lost_ = false;
  lost_for_s_ = 0;
  overruns_in_a_row_ = 0;
  fault_count_ = 0;
  first_fault_ = {};
}

void Safety::degrade_joint(std::size_t joint, SafetyLevel level, const Fault& fault) noexcept {
  if (joint_levels_[joint] >= level) return;
  joint_levels_[joint] = level;
  raise(fault);
}

// A silent behavior engine: hold at once, damp after hold_s, off after another damp_s. A heartbeat that returns while
// holding lifts the hold; from damp on only clearing does.
void Safety::watch_engine(const SafetyInput& input) noexcept {
  if (input.missed_ticks > 0) {
    const auto missed = static_cast<double>(input.missed_ticks);
    raise({.code = FaultCode::tick_overrun, .tick = input.tick, .value = missed});
    if (++overruns_in_a_row_ >= settings_.overruns_in_a_row_max) robot_level_ = std::max(robot_level_, SafetyLevel::damp);
  } else {
    overruns_in_a_row_ = 0;
  }
  const bool lost = !(input.heartbeat_age_s <= settings_.heartbeat_timeout_s);
  if (lost && !heartbeat_lost_) {
    raise({.code = FaultCode::heartbeat_lost,
           .tick = input.tick,
           .value = input.heartbeat_age_s,
           .limit = settings_.heartbeat_timeout_s});
  }
  heartbeat_lost_ = lost;
  if (lost) {
    lost_for_s_ += input.dt_s;
    const SafetyLevel level = lost_for_s_ <= settings_.hold_s                      ? SafetyLevel::hold
                              : lost_for_s_ <= settings_.hold_s + settings_.damp_s ? SafetyLevel::damp
                                                                                   : SafetyLevel::off;
    robot_level_ = std::max(robot_level_, level);
  } else if (robot_level_ == SafetyLevel::hold) {
    robot_level_ = SafetyLevel::normal;
    lost_for_s_ = 0;
  }
}

void Safety::watch_joint(const SafetyInput& input, std::size_t joint, const JointActuation& actuation) noexcept {
  const JointState& state = input.joints.joints[joint];
  const JointLimits& limits = settings_.joints[joint];
  const SensorState& sensor = input.health.joints[joint];
  const auto fault = [&](FaultCode code, double value, double limit) {
    return Fault{code, static_cast<std::uint16_t>(joint), input.tick, value, limit};
  };
  if (!sensor.finite) degrade_joint(joint, SafetyLevel::off, fault(FaultCode::sensor_not_finite, state.position_rad, 0));
  const std::uint32_t silent_max = settings_.silent_ticks_max + sensor.period_ticks - 1;
  if (sensor.silent_ticks > silent_max) {
    degrade_joint(joint, SafetyLevel::off, fault(FaultCode::sensor_silent, sensor.silent_ticks, silent_max));
  }
  if (!finite(actuation)) {
    degrade_joint(joint, SafetyLevel::damp, fault(FaultCode::actuation_not_finite, actuation.effort_Nm, 0));
  }
  if (limits.effort_max_Nm == 0) return;  // passive: nothing to take away
  const double lower = limits.lower_rad - settings_.position_margin_rad;
  const double upper = limits.upper_rad + settings_.position_margin_rad;
  if (!(state.position_rad >= lower && state.position_rad <= upper)) {
    const double broken = state.position_rad < limits.lower_rad ? limits.lower_rad : limits.upper_rad;
    degrade_joint(joint, SafetyLevel::damp, fault(FaultCode::position_limit, state.position_rad, broken));
  }
  const double fastest = limits.velocity_max_rad_s * settings_.velocity_margin;
  if (!(std::abs(state.velocity_rad_s) <= fastest)) {
    degrade_joint(joint, SafetyLevel::damp, fault(FaultCode::velocity_limit, state.velocity_rad_s, fastest));
  }
}

void Safety::limit_joint(const SafetyInput& input, std::size_t joint, JointActuation& actuation) noexcept {
  const double effort_max_Nm = settings_.joints[joint].effort_max_Nm;
  const SafetyLevel level = std::max(joint_levels_[joint], robot_level_);
  if (effort_max_Nm == 0 || level == SafetyLevel::off) {
    actuation = {};
    return;
  }
  if (level == SafetyLevel::damp) {
    const double effort_Nm = -settings_.damping_Nms_per_rad * input.joints.joints[joint].velocity_rad_s;
    actuation = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
  const bool too_much = !(std::abs(actuation.effort_Nm) <= effort_max_Nm);
  if (too_much && !limiting_[joint]) {
    raise({FaultCode::effort_limit, static_cast<std::uint16_t>(joint), input.tick, actuation.effort_Nm, effort_max_Nm});
  }
  if (too_much) actuation.effort_Nm = std::clamp(actuation.effort_Nm, -effort_max_Nm, effort_max_Nm);
  limiting_[joint] = too_much;
  limited_ = limited_ || too_much;
}

void Safety::check(const SafetyInput& input, ActuationFrame& actuation, SafetyStatus& status) noexcept {
  limited_ = false;
  watch_engine(input);
  SafetyLevel worst = robot_level_;
  for (std::size_t joint = 0; joint < joint_count_; ++joint) {
    watch_joint(input, joint, actuation.joints[joint]);
    limit_joint(input, joint, actuation.joints[joint]);
    worst = std::max(worst, joint_levels_[joint]);
  }
  if (limited_) worst = std::max(worst, SafetyLevel::limited);
  status.level = worst;
  status.fault_count = fault_count_;
  status.first_fault = first_fault_;
  level_number_ = static_cast<std::uint32_t>(worst);
}

}  // namespace kadans
