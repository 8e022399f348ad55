#include "kadans/testing/one_joint_plant.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace kadans::testing {
namespace {

constexpr std::int64_t substep_ns = 50'000;

void require(const char* key, double value, double min, double max) {
  if (value >= min && value <= max) return;
  throw std::invalid_argument("one-joint plant: " + std::string(key) + " is " + std::to_string(value) +
                              ", must be in " + std::to_string(min) + ".." + std::to_string(max));
}

// The velocity after dt_s under a torque, viscous friction and Coulomb friction, which never turns it round.
double moved(double velocity_rad_s, double torque_Nm, double inertia_kg_m2, double viscous, double coulomb_Nm,
             double dt_s) noexcept {
  const double free = (velocity_rad_s + dt_s * torque_Nm / inertia_kg_m2) / (1 + dt_s * viscous / inertia_kg_m2);
  const double lost = dt_s * coulomb_Nm / inertia_kg_m2;
  return std::abs(free) <= lost ? 0 : free - std::copysign(lost, free);
}

}  // namespace

OneJointPlant::OneJointPlant(const Config& config) : config_(config) {
  constexpr double most = 1e6;
  require("inertia_kg_m2", config.inertia_kg_m2, 1e-6, most);
  require("rotor_inertia_kg_m2", config.rotor_inertia_kg_m2, config.spring_Nm_per_rad > 0 ? 1e-6 : 0, most);
  require("viscous_Nms_per_rad", config.viscous_Nms_per_rad, 0, most);
  require("coulomb_Nm", config.coulomb_Nm, 0, most);
  require("gravity_Nm", config.gravity_Nm, -most, most);
  require("load_Nm", config.load_Nm, -most, most);
  require("spring_Nm_per_rad", config.spring_Nm_per_rad, 0, most);
  require("spring_damping_Nms_per_rad", config.spring_damping_Nms_per_rad, 0, most);
  require("delay_ticks", config.delay_ticks, 0, max_delay_ticks);
  require("torque_max_Nm", config.torque_max_Nm, 0, std::numeric_limits<double>::infinity());
  require("encoder_resolution_rad", config.encoder_resolution_rad, 0, most);
  require("position_gain_Nm_per_rad", config.position_gain_Nm_per_rad, 0, most);
  require("velocity_gain_Nms_per_rad", config.velocity_gain_Nms_per_rad, 0, most);
  require("position_rad", config.position_rad, -most, most);
  state_.position_rad = state_.motor_position_rad = config.position_rad;
}

void OneJointPlant::read(SensorFrame& sensors) noexcept {
  const auto quantised = [step = config_.encoder_resolution_rad](double position_rad) {
    return step > 0 ? step * std::round(position_rad / step) : position_rad;
  };
  sensors.time_ns = time_ns_;
  sensors.joint_count = 1;
  sensors.foot_count = 0;
  sensors.joints[0] = {quantised(state_.position_rad), quantised(state_.motor_position_rad), state_.torque_Nm,
                       sequence_ + 1};
  sensors.imu = {{0, 0, 0}, {0, 0, 9.81}, sequence_ + 1};
}

void OneJointPlant::write(const ActuationFrame& actuation) noexcept {
  const JointActuation& asked = actuation.joints[0];
  const bool finite = is_finite(asked);
  written_[ticks_ % written_.size()] = finite && actuation.joint_count > 0 ? asked : JointActuation{};
}

double OneJointPlant::drive_Nm(const JointActuation& asked) const noexcept {
  if (asked.mode == ActuationMode::off) return 0;
  double torque_Nm = asked.effort_Nm;
  const bool by_asked = asked.mode == ActuationMode::impedance;
  if (asked.mode != ActuationMode::effort) {
    torque_Nm += (by_asked ? asked.damping_Nms_per_rad : config_.velocity_gain_Nms_per_rad) *
                 (asked.velocity_rad_s - state_.motor_velocity_rad_s);
  }
  if (has_position(asked.mode)) {
    torque_Nm += (by_asked ? asked.stiffness_Nm_per_rad : config_.position_gain_Nm_per_rad) *
                 (asked.position_rad - state_.motor_position_rad);
  }
  return torque_Nm;
}

void OneJointPlant::move_rigid(double drive_Nm, double dt_s) noexcept {
  State& s = state_;
  const Config& c = config_;
  const double torque_Nm = drive_Nm - c.gravity_Nm * std::sin(s.position_rad) + c.load_Nm + push_Nm_;
  s.velocity_rad_s = moved(s.velocity_rad_s, torque_Nm, c.inertia_kg_m2 + c.rotor_inertia_kg_m2, c.viscous_Nms_per_rad,
                           c.coulomb_Nm, dt_s);
  s.position_rad += dt_s * s.velocity_rad_s;
  s.motor_position_rad = s.position_rad;
  s.motor_velocity_rad_s = s.velocity_rad_s;
}

void OneJointPlant::move_elastic(double drive_Nm, double dt_s) noexcept {
  State& s = state_;
  const Config& c = config_;
  const double spring_Nm = c.spring_Nm_per_rad * (s.motor_position_rad - s.position_rad) +
                           c.spring_damping_Nms_per_rad * (s.motor_velocity_rad_s - s.velocity_rad_s);
  const double link_Nm = spring_Nm - c.gravity_Nm * std::sin(s.position_rad) + c.load_Nm + push_Nm_;
  s.motor_velocity_rad_s = moved(s.motor_velocity_rad_s, drive_Nm - spring_Nm, c.rotor_inertia_kg_m2,
                                 c.viscous_Nms_per_rad, c.coulomb_Nm, dt_s);
  s.velocity_rad_s += dt_s * link_Nm / c.inertia_kg_m2;
  s.motor_position_rad += dt_s * s.motor_velocity_rad_s;
  s.position_rad += dt_s * s.velocity_rad_s;
}

void OneJointPlant::step(std::int64_t dt_ns) {
  if (dt_ns <= 0) return;
  const auto size = static_cast<std::uint32_t>(written_.size());
  const JointActuation asked = written_[(ticks_ + size - config_.delay_ticks) % size];
  const std::int64_t steps = (dt_ns + substep_ns - 1) / substep_ns;
  const double dt_s = static_cast<double>(dt_ns) * 1e-9 / static_cast<double>(steps);
  double sum_Nm = 0;
  state_.saturated = false;
  for (std::int64_t i = 0; i < steps; ++i) {
    const double wanted_Nm = drive_Nm(asked);
    const double given_Nm = std::clamp(wanted_Nm, -config_.torque_max_Nm, config_.torque_max_Nm);
    state_.saturated = state_.saturated || given_Nm != wanted_Nm;
    if (i == 0) state_.first_torque_Nm = given_Nm;
    sum_Nm += given_Nm;
    if (config_.spring_Nm_per_rad > 0) {
      move_elastic(given_Nm, dt_s);
    } else {
      move_rigid(given_Nm, dt_s);
    }
  }
  state_.torque_Nm = sum_Nm / static_cast<double>(steps);
  push_Nm_ = 0;
  state_.last_torque_Nm = std::clamp(drive_Nm(asked), -config_.torque_max_Nm, config_.torque_max_Nm);
  const JointActuation held = written_[ticks_ % size];
  written_[++ticks_ % size] = held;  // until the next write
  time_ns_ += dt_ns;
  ++sequence_;
}

}  // namespace kadans::testing
