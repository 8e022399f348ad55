#include "kadans/control/joint_axis.h"

#include <cmath>
#include <stdexcept>

namespace kadans {
namespace {

constexpr double unlimited_rad = 1e6;  // of a continuous joint's set-point

double finite_or(double limit, double fallback) { return std::abs(limit) < unlimited_rad ? limit : fallback; }

}  // namespace

std::vector<JointAxis> joint_axes(const ObjectSetup& setup) {
  std::vector<JointAxis> axes;
  for (const std::size_t index : setup.joints) {
    const Joint& joint = setup.model.joints.at(index);
    if (joint.passive()) throw std::invalid_argument("joint " + joint.name + " is passive: it has no motor to control");
    axes.push_back({.joint = index,
                    .name = joint.name,
                    .lower_rad = finite_or(joint.lower_rad, -unlimited_rad),
                    .upper_rad = finite_or(joint.upper_rad, unlimited_rad),
                    .velocity_max_rad_s = joint.velocity_max_rad_s,
                    .effort_max_Nm = joint.effort_max_Nm});
  }
  return axes;
}

void AxisTables::tunable(const char* name, const char* unit, double min, double max, double initial, double* value,
                         const char* doc) {
  declaration_.parameter({axis_.name + "." + name, unit, min, max, initial, doc}, value);
}

void AxisTables::setpoint(const char* name, const char* unit, double min, double max, const char* doc,
                          std::uint32_t which, bool own_motion, double safe) {
  declaration_.setpoint({.name = axis_.name + "." + name,
                         .unit = unit,
                         .min = min,
                         .max = max,
                         .doc = doc,
                         .channel = first_channel_ + which,
                         .joint = static_cast<std::uint32_t>(axis_.joint),
                         .own_motion = own_motion,
                         .safe = safe});
}

void AxisTables::position_setpoint(std::uint32_t which, bool own_motion) {
  setpoint("position_rad", "rad", axis_.lower_rad, axis_.upper_rad, "Where the joint shall be.", which, own_motion);
}

void AxisTables::pid(Pid& pid) {
  Pid::Config& c = pid.config();
  const Pid::State& s = pid.state();
  const double most = axis_.effort_max_Nm;
  tunable("kp_Nm_per_rad", "Nm/rad", 0, 50000, 0, &c.kp_Nm_per_rad, "Torque per position error.");
  tunable("ki_Nm_per_rads", "Nm/(rad s)", 0, 50000, 0, &c.ki_Nm_per_rads, "Growth of torque per position error.");
  tunable("kd_Nms_per_rad", "Nm s/rad", 0, 5000, 0, &c.kd_Nms_per_rad, "Torque per velocity error.");
  tunable("kd_cutoff_Hz", "Hz", 0, 1000, 0, &c.kd_cutoff_Hz, "Low pass on the measured velocity; 0 is none.");
  tunable("velocity_weight", "", 0, 1, 1, &c.velocity_weight, "Share of the reference's velocity that kd sees.");
  tunable("integral_max_Nm", "Nm", 0, most, most, &c.integral_max_Nm, "Bound of the integral.");
  tunable("feedforward_Nm", "Nm", -most, most, 0, &c.feedforward_Nm, "Torque added always.");
  tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  signal("reference_rad", "rad", "Set-point of the position.", &s.reference_rad);
  signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  signal("error_rad", "rad", "Set-point minus position.", &s.error_rad);
  signal("integral_Nm", "Nm", "Torque of the integral.", &s.integral_Nm);
  signal("effort_Nm", "Nm", "Torque computed.", &s.effort_Nm);
  signal("saturated", "", "Whether the torque was limited.", &s.saturated);
}

}  // namespace kadans
