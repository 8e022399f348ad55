#include "kadans/control/joint_pid.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>

namespace kadans {
namespace {

constexpr double cancel_time_s = 0.1;
constexpr double unlimited_rad = 1e6;  // of a continuous joint's set-point

double finite_or(double limit, double fallback) { return std::abs(limit) < unlimited_rad ? limit : fallback; }

}  // namespace

JointPid::JointPid(const ObjectSetup& setup) {
  for (const std::size_t index : setup.joints) {
    const Joint& joint = setup.model.joints.at(index);
    if (joint.passive()) throw std::invalid_argument("joint " + joint.name + " is passive: it has no motor to control");
    axes_.push_back({.joint = index,
                     .name = joint.name,
                     .lower_rad = finite_or(joint.lower_rad, -unlimited_rad),
                     .upper_rad = finite_or(joint.upper_rad, unlimited_rad),
                     .effort_max_Nm = joint.effort_max_Nm,
                     .reference = {},
                     .pid = {}});
  }
}

void JointPid::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    Axis& axis = axes_[i];
    Pid::Config& c = axis.pid.config();
    const Pid::State& s = axis.pid.state();
    const double most = axis.effort_max_Nm;
    const auto tunable = [&](const char* name, const char* unit, double min, double max, double initial, double* value,
                             const char* doc) {
      declaration.parameter({axis.name + "." + name, unit, min, max, initial, doc}, value);
    };
    tunable("kp_Nm_per_rad", "Nm/rad", 0, 5000, 0, &c.kp_Nm_per_rad, "Torque per position error.");
    tunable("ki_Nm_per_rads", "Nm/(rad s)", 0, 50000, 0, &c.ki_Nm_per_rads, "Growth of torque per position error.");
    tunable("kd_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.kd_Nms_per_rad, "Torque per velocity error.");
    tunable("kd_cutoff_Hz", "Hz", 0, 1000, 0, &c.kd_cutoff_Hz, "Low pass on the measured velocity; 0 is none.");
    tunable("velocity_weight", "", 0, 1, 1, &c.velocity_weight, "Share of the reference's velocity that kd sees.");
    tunable("integral_max_Nm", "Nm", 0, most, most, &c.integral_max_Nm, "Bound of the integral.");
    tunable("feedforward_Nm", "Nm", -most, most, 0, &c.feedforward_Nm, "Torque added always.");
    tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
    declaration.setpoint({.name = axis.name + ".position_rad",
                          .unit = "rad",
                          .min = axis.lower_rad,
                          .max = axis.upper_rad,
                          .doc = "Where the joint shall be.",
                          .channel = static_cast<std::uint32_t>(i),
                          .joint = static_cast<std::uint32_t>(axis.joint)});
    declaration.signal({axis.name + ".reference_rad", "rad", "Set-point of the position."}, &s.reference_rad);
    declaration.signal({axis.name + ".reference_velocity_rad_s", "rad/s", "Its velocity."},
                       &s.reference_velocity_rad_s);
    declaration.signal({axis.name + ".error_rad", "rad", "Set-point minus position."}, &s.error_rad);
    declaration.signal({axis.name + ".integral_Nm", "Nm", "Torque of the integral."}, &s.integral_Nm);
    declaration.signal({axis.name + ".effort_Nm", "Nm", "Torque computed."}, &s.effort_Nm);
    declaration.signal({axis.name + ".saturated", "", "Whether the torque was limited."}, &s.saturated);
  }
}

void JointPid::start(const ControlInput& input) noexcept {
  for (Axis& axis : axes_) {
    const JointState& joint = input.joints.joints[axis.joint];
    const JointActuation& last = input.last.joints[axis.joint];
    axis.reference.reset(std::clamp(joint.position_rad, axis.lower_rad, axis.upper_rad));
    axis.pid.start(joint.position_rad, joint.velocity_rad_s, last.mode == ActuationMode::effort ? last.effort_Nm : 0);
  }
}

void JointPid::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  for (Axis& axis : axes_) {
    const JointState& joint = input.joints.joints[axis.joint];
    const MinimumJerk::State& reference = axis.reference.step(input.dt_s);
    const double effort_Nm =
        axis.pid.step(reference.position, reference.velocity, joint.position_rad, joint.velocity_rad_s, input.dt_s);
    actuation.joints[axis.joint] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
}

void JointPid::set_point(std::uint32_t channel, double value, double duration_s) noexcept {
  axes_[channel].reference.move(value, duration_s);
}

void JointPid::cancel_motion(std::uint32_t channel) noexcept {
  Axis& axis = axes_[channel];
  axis.reference.stop(cancel_time_s);
}

double JointPid::motion_remaining_s() const noexcept {
  double remaining_s = 0;
  for (const Axis& axis : axes_) remaining_s = std::max(remaining_s, axis.reference.remaining_s());
  return remaining_s;
}

std::unique_ptr<ControlObject> make_joint_pid(const ObjectSetup& setup) { return std::make_unique<JointPid>(setup); }

}  // namespace kadans
