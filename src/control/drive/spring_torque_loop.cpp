#include "spring_torque_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans {
namespace {

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

void SpringTorqueLoop::restart() noexcept {
  rate_.reset();
  state_ = {};
  fresh_ = true;
}

double SpringTorqueLoop::stiffest_gain() const noexcept {
  const double w = turn * config_.bandwidth_Hz;
  return std::max(0.0, w * w * config_.rotor_inertia_kg_m2 / config_.spring_Nm_per_rad - 1);
}

double SpringTorqueLoop::observe(double rotor_rad_s, double dt_s) noexcept {
  const double rotor_Nms = config_.rotor_inertia_kg_m2 * rotor_rad_s;
  if (fresh_ || config_.observer_Hz == 0) {
    momentum_Nms_ = rotor_Nms;
    fresh_ = false;
    return 0;
  }
  momentum_Nms_ += dt_s * (state_.motor_Nm - state_.torque_Nm - state_.disturbance_Nm);
  return turn * config_.observer_Hz * (momentum_Nms_ - rotor_Nms);
}

double SpringTorqueLoop::step(double wanted_Nm, const JointState& joint, double dt_s) noexcept {
  if (!std::isfinite(joint.velocity_rad_s + joint.effort_Nm) || !(dt_s > 0)) {
    restart();
    return wanted_Nm;
  }
  State& s = state_;
  const double rate_Nm_s = rate_.update(joint.effort_Nm, dt_s);
  s.disturbance_Nm = observe(joint.velocity_rad_s + rate_Nm_s / config_.spring_Nm_per_rad, dt_s);
  s.wanted_Nm = wanted_Nm;
  s.torque_Nm = joint.effort_Nm;
  s.rate_Nm_s = rate_Nm_s;
  const double damping_s =
      2 * config_.damping_ratio * turn * config_.bandwidth_Hz * config_.rotor_inertia_kg_m2 / config_.spring_Nm_per_rad;
  const double asked_Nm =
      wanted_Nm + stiffest_gain() * (wanted_Nm - s.torque_Nm) - damping_s * rate_Nm_s + s.disturbance_Nm;
  s.motor_Nm = std::clamp(asked_Nm, -config_.effort_max_Nm, config_.effort_max_Nm);
  s.saturated = s.motor_Nm != asked_Nm;
  return s.motor_Nm;
}

}  // namespace kadans
