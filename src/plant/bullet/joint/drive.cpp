#include "drive.h"

#include <algorithm>
#include <cmath>

namespace kadans::bullet {

Drive::Drive(const DriveSettings& settings, const Joint& joint, JointRows& rows, double position_rad)
    : settings_(settings), rows_(&rows) {
  settings_.viscous_Nms_per_rad += joint.damping_Nms_per_rad;
  settings_.coulomb_Nm += joint.friction_Nm;
  state_.rotor_rad = position_rad;
}

double Drive::available_Nm(double direction, double velocity_rad_s) const {
  const double speed = direction * velocity_rad_s;
  const double knee = settings_.knee_velocity_rad_s, no_load = settings_.velocity_max_rad_s;
  if (no_load <= 0 || speed <= knee) return settings_.torque_max_Nm;
  if (speed >= no_load) return 0;
  return settings_.torque_max_Nm * (no_load - speed) / (no_load - knee);
}

// A step's torque is one number while the speed changes: what the line allows at the better of both ends.
double Drive::most_Nm(double before_rad_s, double after_rad_s) const {
  const double direction = state_.motor_torque_Nm < 0 ? -1 : 1;
  return std::max(available_Nm(direction, before_rad_s), available_Nm(direction, after_rad_s));
}

TorqueLaw Drive::law(double position_rad, double velocity_rad_s, double dt_s) const {
  const double torque_max = settings_.torque_max_Nm, no_load = settings_.velocity_max_rad_s;
  const JointActuation& asked = actuation_;
  if (torque_max == 0 || asked.mode == ActuationMode::off) return {};
  if (asked.mode == ActuationMode::effort) {
    const double torque = std::clamp(asked.effort_Nm, -torque_max, torque_max);
    const double direction = torque < 0 ? -1 : 1;
    const double knee = std::min(settings_.knee_velocity_rad_s, 0.999 * no_load);
    if (no_load <= 0 || torque == 0 || direction * velocity_rad_s < 0.5 * knee) return {torque, 0, torque, torque};
    const double slope = torque_max / (no_load - knee);  // of the speed-torque line, followed implicitly
    return {direction * slope * no_load, slope, std::min(torque, 0.0), std::max(torque, 0.0)};
  }
  const bool by_asked = asked.mode == ActuationMode::impedance;
  const double own_kp = asked.mode == ActuationMode::position ? settings_.position_gain_Nm_per_rad : 0;
  const double kp = by_asked ? asked.stiffness_Nm_per_rad : own_kp;
  const double kd = by_asked ? asked.damping_Nms_per_rad : settings_.velocity_gain_Nms_per_rad;
  return {kp * (asked.position_rad - position_rad) + kd * asked.velocity_rad_s + asked.effort_Nm, kd + dt_s * kp,
          -available_Nm(-1, velocity_rad_s), available_Nm(1, velocity_rad_s)};
}

double Drive::begin_step(double position_rad, double velocity_rad_s, double dt_s) {
  rows_->clear();
  velocity_before_rad_s_ = velocity_rad_s;
  return elastic() ? begin_elastic(position_rad, velocity_rad_s, dt_s)
                   : begin_rigid(position_rad, velocity_rad_s, dt_s);
}

double Drive::begin_rigid(double position_rad, double velocity_rad_s, double dt_s) {
  const double inertia = settings_.rotor_inertia_kg_m2, spring = settings_.parallel_spring_Nm_per_rad;
  const double damping = settings_.viscous_Nms_per_rad + settings_.parallel_damping_Nms_per_rad;
  rows_->set_linear(inertia * velocity_rad_s + dt_s * spring * (settings_.parallel_rest_rad - position_rad),
                    inertia + dt_s * damping + dt_s * dt_s * spring);
  rows_->set_friction(dt_s * dry_Nm());
  const TorqueLaw motor = law(position_rad, velocity_rad_s, dt_s);
  if (motor.slope_Nms_per_rad == 0) {
    state_.motor_torque_Nm = std::clamp(motor.at_rest_Nm, motor.lower_Nm, motor.upper_Nm);
    return state_.motor_torque_Nm;
  }
  state_.motor_torque_Nm = 0;  // known after the step
  rows_->set_servo(dt_s * motor.at_rest_Nm, dt_s * motor.slope_Nms_per_rad, dt_s * motor.lower_Nm,
                   dt_s * motor.upper_Nm);
  return 0;
}

double Drive::begin_elastic(double position_rad, double velocity_rad_s, double dt_s) {
  const double spring = settings_.parallel_spring_Nm_per_rad, damping = settings_.parallel_damping_Nms_per_rad;
  rows_->set_linear(dt_s * spring * (settings_.parallel_rest_rad - position_rad),
                    dt_s * damping + dt_s * dt_s * spring);
  const double radians_per_step = dt_s * std::sqrt(settings_.spring_Nm_per_rad / settings_.rotor_inertia_kg_m2);
  const int steps = std::max(1, static_cast<int>(std::ceil(radians_per_step)));
  const double small_dt_s = dt_s / steps;
  const double before_rad_s = state_.rotor_velocity_rad_s;
  double torque_sum = 0, motor_sum = 0;
  for (int i = 0; i < steps; ++i) {
    torque_sum += step_rotor(position_rad + i * small_dt_s * velocity_rad_s, velocity_rad_s, small_dt_s);
    motor_sum += state_.motor_torque_Nm;
  }
  state_.motor_torque_Nm = motor_sum / steps;
  state_.motor_torque_max_Nm = most_Nm(before_rad_s, state_.rotor_velocity_rad_s);
  state_.joint_torque_Nm = torque_sum / steps;
  return state_.joint_torque_Nm;
}

// Advances the rotor by one step against the spring, the joint being here now; returns the spring's torque.
double Drive::step_rotor(double position_rad, double velocity_rad_s, double dt_s) {
  double& rotor_velocity = state_.rotor_velocity_rad_s;
  const double spring_Nm = settings_.spring_Nm_per_rad * (state_.rotor_rad - position_rad) +
                           settings_.spring_damping_Nms_per_rad * (rotor_velocity - velocity_rad_s);
  const double inertia = settings_.rotor_inertia_kg_m2, viscous = settings_.viscous_Nms_per_rad;
  const TorqueLaw motor = law(state_.rotor_rad, rotor_velocity, dt_s);
  const double momentum = inertia * rotor_velocity - dt_s * spring_Nm;
  double resistance = inertia + dt_s * (viscous + motor.slope_Nms_per_rad);
  double velocity = (momentum + dt_s * motor.at_rest_Nm) / resistance;
  const double wanted_Nm = motor.at_rest_Nm - motor.slope_Nms_per_rad * velocity;
  state_.motor_torque_Nm = std::clamp(wanted_Nm, motor.lower_Nm, motor.upper_Nm);
  if (state_.motor_torque_Nm != wanted_Nm) {
    resistance = inertia + dt_s * viscous;
    velocity = (momentum + dt_s * state_.motor_torque_Nm) / resistance;
  }
  const double stop = dt_s * dry_Nm() / resistance;  // what dry friction can take off in this step
  velocity -= std::clamp(velocity, -stop, stop);
  rotor_velocity = velocity;
  state_.rotor_rad += dt_s * velocity;
  return spring_Nm;
}

void Drive::end_step(double position_rad, double velocity_rad_s, double dt_s) {
  if (elastic()) return;
  state_.motor_torque_Nm += rows_->impulse(JointRows::servo) / dt_s;
  state_.motor_torque_max_Nm = most_Nm(velocity_before_rad_s_, velocity_rad_s);
  const double friction_Nm =
      rows_->impulse(JointRows::friction) / dt_s - settings_.viscous_Nms_per_rad * velocity_rad_s;
  const double inertia_Nm = settings_.rotor_inertia_kg_m2 * (velocity_before_rad_s_ - velocity_rad_s) / dt_s;
  state_.joint_torque_Nm = state_.motor_torque_Nm + friction_Nm + inertia_Nm;
  state_.rotor_rad = position_rad;
  state_.rotor_velocity_rad_s = velocity_rad_s;
}

void Drive::hash(StateHash& hash) const noexcept {
  hash.add(state_.rotor_rad);
  hash.add(state_.rotor_velocity_rad_s);
  for (const auto kind : {JointRows::linear, JointRows::servo, JointRows::friction, JointRows::limit}) {
    hash.add(rows_->impulse(kind));  // the solver starts from it
  }
  hash.add(rows_->servo_at_limit() ? 1.0 : 0.0);
}

}  // namespace kadans::bullet
