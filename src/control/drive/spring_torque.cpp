#include "spring_torque.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace kadans {
namespace {

constexpr double turn = 2 * std::numbers::pi;

}  // namespace

SpringTorque::SpringTorque(const ObjectSetup& setup) {
  for (JointAxis& axis : joint_axes(setup)) {
    const std::size_t joint = axis.joint;
    if (joint >= setup.drives.size() || !(setup.drives[joint].spring_Nm_per_rad > 0)) {
      throw std::invalid_argument("joint " + axis.name + " has no spring between motor and joint");
    }
    Part& part = parts_.emplace_back();
    part.loop.config() = {.spring_Nm_per_rad = setup.drives[joint].spring_Nm_per_rad,
                          .rotor_inertia_kg_m2 = setup.drives[joint].rotor_inertia_kg_m2,
                          .effort_max_Nm = axis.effort_max_Nm};
    part.axis = std::move(axis);
  }
}

void SpringTorque::declare(Declaration& declaration) {
  for (Part& part : parts_) declare(declaration, part);
}

void SpringTorque::declare(Declaration& declaration, Part& part) {
  AxisTables tables(declaration, part.axis, 0);
  SpringTorqueLoop::Config& c = part.loop.config();
  tables.tunable("spring_Nm_per_rad", "Nm/rad", 1, 1e5, c.spring_Nm_per_rad, &c.spring_Nm_per_rad,
                 "Stiffness of the spring, as the loop believes it.");
  tables.tunable("rotor_inertia_kg_m2", "kg m2", 1e-5, 1, c.rotor_inertia_kg_m2, &c.rotor_inertia_kg_m2,
                 "Inertia of the rotor, reflected to the joint, as the loop believes it.");
  tables.tunable("bandwidth_Hz", "Hz", 1, 200, c.bandwidth_Hz, &c.bandwidth_Hz,
                 "Of the torque; not below what the rotor does by itself.");
  tables.tunable("damping_ratio", "", 0, 3, c.damping_ratio, &c.damping_ratio, "Of the torque's answer.");
  tables.tunable("rate_cutoff_Hz", "Hz", 10, 400, c.rate_cutoff_Hz, &c.rate_cutoff_Hz,
                 "Cut-off of the low pass on the torque's rate; a light load on the spring wants it low.");
  tables.tunable("observer_Hz", "Hz", 0, 50, c.observer_Hz, &c.observer_Hz,
                 "How fast friction and the like are found and made up for; 0: never.");
  tables.tunable("share", "", 0, 1, part.share, &part.share, "Of the loop's work; 0: the motor gets what is wanted.");
  const SpringTorqueLoop::State& s = part.loop.state();
  tables.signal("wanted_Nm", "Nm", "Torque wanted at the joint.", &s.wanted_Nm);
  tables.signal("torque_Nm", "Nm", "Torque of the spring.", &s.torque_Nm);
  tables.signal("disturbance_Nm", "Nm", "What the motor's torque does not explain.", &s.disturbance_Nm);
  tables.signal("motor_Nm", "Nm", "Torque asked of the motor.", &s.motor_Nm);
  tables.signal("saturated", "", "Whether the motor's torque is limited.", &s.saturated);
}

void SpringTorque::parameters_changed() noexcept {
  for (Part& part : parts_) (void)part.loop.retune();
}

void SpringTorque::start(const ControlInput&) noexcept {
  for (Part& part : parts_) part.loop.restart();
}

void SpringTorque::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  for (Part& part : parts_) {
    JointActuation& asked = actuation.joints[part.axis.joint];
    if (asked.mode != ActuationMode::effort) {
      part.loop.restart();
      continue;
    }
    const double motor_Nm = part.loop.step(asked.effort_Nm, input.joints.joints[part.axis.joint], input.dt_s);
    asked.effort_Nm += part.share * (motor_Nm - asked.effort_Nm);
  }
}

void SpringTorque::rehearse(const ControlInput& input) const noexcept {
  for (const Part& part : parts_) {
    SpringTorqueLoop loop = part.loop;
    const std::size_t joint = part.axis.joint;
    (void)loop.step(input.last.joints[joint].effort_Nm, input.joints.joints[joint], input.dt_s);
  }
}

std::unique_ptr<ControlObject> make_spring_torque(const ObjectSetup& setup) {
  return std::make_unique<SpringTorque>(setup);
}

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
