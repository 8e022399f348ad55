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
  for (const JointAxis& axis : joint_axes(setup)) {
    if (setup.model.coupling_of(axis.joint) != nullptr) continue;
    const DriveLaw drive = axis.joint < setup.drives.size() ? setup.drives[axis.joint] : DriveLaw{};
    add(axis, {.spring_Nm_per_rad = drive.spring_Nm_per_rad,
               .rotor_inertia_kg_m2 = drive.rotor_inertia_kg_m2,
               .effort_max_Nm = axis.effort_max_Nm});
  }
  single_ = parts_.size();
  for (const std::size_t joint : setup.joints) {
    const Transmission* const coupling = setup.model.coupling_of(joint);
    if (coupling == nullptr) continue;
    if (coupling->joints()[0] == joint) add_pair(setup, *coupling);
    for (const std::size_t other : coupling->joints()) {
      if (std::ranges::find(setup.joints, other) != setup.joints.end()) continue;
      throw std::invalid_argument("joint " + setup.model.joints[joint].name + " is coupled with " +
                                  setup.model.joints[other].name + ": their drives' springs need both");
    }
  }
}

void SpringTorque::add(JointAxis axis, const SpringTorqueLoop::Config& config) {
  if (!(config.spring_Nm_per_rad > 0)) {
    throw std::invalid_argument("joint " + axis.name + " has no spring between motor and joint");
  }
  Part& part = parts_.emplace_back();
  part.axis = std::move(axis);
  part.loop.config() = config;
}

void SpringTorque::add_pair(const ObjectSetup& setup, const Transmission& transmission) {
  const std::vector<std::size_t>& joints = transmission.joints();
  couplings_.push_back(transmission);
  for (std::size_t i = 0; i < 2; ++i) {
    const DriveLaw drive = joints[i] < setup.drives.size() ? setup.drives[joints[i]] : DriveLaw{};
    const std::string& joint = setup.model.joints[joints[i]].name;
    add({.joint = joints[i], .name = transmission.drives().empty() ? joint : transmission.drives()[i]},
        {.spring_Nm_per_rad = drive.spring_Nm_per_rad,
         .rotor_inertia_kg_m2 = drive.own_rotor_inertia_kg_m2,
         .effort_max_Nm = drive.own_effort_max_Nm});
  }
}

void SpringTorque::declare(Declaration& declaration) {
  // A coupled drive is seen from its own side: before a gear of 1:100 all is 10,000 times less.
  for (std::size_t i = 0; i < parts_.size(); ++i) declare(declaration, parts_[i], i < single_ ? 1 : 1e-5);
}

void SpringTorque::declare(Declaration& declaration, Part& part, double least) {
  AxisTables tables(declaration, part.axis, 0);
  SpringTorqueLoop::Config& c = part.loop.config();
  tables.tunable("spring_Nm_per_rad", "Nm/rad", least, 1e5, c.spring_Nm_per_rad, &c.spring_Nm_per_rad,
                 "Stiffness of the spring, as the loop believes it.");
  tables.tunable("rotor_inertia_kg_m2", "kg m2", 1e-5 * least, 1, c.rotor_inertia_kg_m2, &c.rotor_inertia_kg_m2,
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
  for (Part& part : std::span(parts_).first(single_)) {
    JointActuation& asked = actuation.joints[part.axis.joint];
    if (asked.mode != ActuationMode::effort) {
      part.loop.restart();
      continue;
    }
    const double motor_Nm = part.loop.step(asked.effort_Nm, input.joints.joints[part.axis.joint], input.dt_s);
    asked.effort_Nm += part.share * (motor_Nm - asked.effort_Nm);
  }
  for (std::size_t i = 0; i < couplings_.size(); ++i)
    step_pair(input, couplings_[i], std::span(parts_).subspan(single_ + 2 * i, 2), actuation);
}

void SpringTorque::step_pair(const ControlInput& input, const Transmission& coupling, std::span<Part> parts,
                             ActuationFrame& actuation) noexcept {
  const std::size_t first = coupling.joints()[0], second = coupling.joints()[1];
  JointActuation &one = actuation.joints[first], &other = actuation.joints[second];
  if (one.mode != ActuationMode::effort || other.mode != ActuationMode::effort) {
    for (Part& part : parts) part.loop.restart();
    return;
  }
  const JointState &a = input.joints.joints[first], &b = input.joints.joints[second];
  const Transmission::Pair velocity_rad_s = coupling.drive_velocity_rad_s({a.velocity_rad_s, b.velocity_rad_s});
  const Transmission::Pair spring_Nm = coupling.drive_effort_Nm({a.effort_Nm, b.effort_Nm});
  Transmission::Pair effort_Nm = coupling.drive_effort_Nm({one.effort_Nm, other.effort_Nm});
  for (std::size_t i = 0; i < 2; ++i) {
    const JointState drive{.velocity_rad_s = velocity_rad_s[i], .effort_Nm = spring_Nm[i]};
    effort_Nm[i] += parts[i].share * (parts[i].loop.step(effort_Nm[i], drive, input.dt_s) - effort_Nm[i]);
  }
  effort_Nm = coupling.joint_effort_Nm(effort_Nm);
  one.effort_Nm = effort_Nm[0];
  other.effort_Nm = effort_Nm[1];
}

void SpringTorque::rehearse(const ControlInput& input) const noexcept {
  for (const Part& part : std::span(parts_).first(single_)) {
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
