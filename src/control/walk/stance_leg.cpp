#include "stance_leg.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "control/option_link.h"

namespace kadans {
namespace {

constexpr double effort_share = 0.9;  // of a joint's limit; the position loops add theirs

}  // namespace

StanceLeg::StanceLeg(const ObjectSetup& setup)
    : foot_(required_link(setup, "foot", "the link that stands")),
      kinematics_(setup.model),
      leg_(setup.model, foot_),
      weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {
  for (JointAxis& axis : joint_axes(setup)) {
    if (!leg_.bears(axis.joint))
      throw std::invalid_argument("joint " + axis.name + " does not lead to the foot " + setup.model.links[foot_].name);
    parts_.push_back({.axis = std::move(axis)});
  }
}

void StanceLeg::declare(Declaration& d) {
  Config& c = config_;
  d.tunable("rise_s", "s", 0, 1, c.rise_s, "Time in which its torques rise after the start.");
  d.tunable("pressure_x_m", "m", -0.5, 0.5, c.pressure_x_m, "Centre of pressure, forward of the foot's frame.");
  c.trunk.declare(d, TrunkRighting::Leans::anyhow, {2000, 200});
  d.tunable("grip", "", 0, 2, c.grip, "Most of the force along the ground, per weight.");
  d.tunable("sole_m", "m", 0, 0.5, c.sole_m, "How far the sole is below the foot's frame.");
  declare_signals(d);
}

void StanceLeg::declare_signals(Declaration& d) {
  const State& s = state_;
  d.signal({"com_x_m", "m", "Centre of mass, forward of the foot's frame."}, &s.com_m[0]);
  d.signal({"com_y_m", "m", "Centre of mass, left of the foot's frame."}, &s.com_m[1]);
  d.signal({"com_z_m", "m", "Centre of mass, above the foot's frame."}, &s.com_m[2]);
  d.signal({"turn_x_Nm", "Nm", "Moment that rights the trunk, to the right."}, &s.turn_x_Nm);
  d.signal({"turn_y_Nm", "Nm", "Moment that rights the trunk, forward."}, &s.turn_y_Nm);
  d.signal({"force_x_N", "N", "Force of the ground that is wanted, forward."}, &s.force_N[0]);
  d.signal({"force_y_N", "N", "Force of the ground that is wanted, to the left."}, &s.force_N[1]);
  d.signal({"force_z_N", "N", "Force of the ground that is wanted, upward."}, &s.force_N[2]);
  d.signal({"share", "", "Share of its torques that acts."}, &s.share);
  declare_efforts(d);
}

bool StanceLeg::measure(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  std::array<double, max_joints> position_rad{};
  for (std::size_t i = 0; i < input.joints.count; ++i) position_rad[i] = input.joints.joints[i].position_rad;
  kinematics_.update({position_rad.data(), input.joints.count},
                     {{}, from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0)});
  const Vec3 com_m = kinematics_.com_m();
  const Vec3& foot_m = kinematics_.link(foot_).position_m;
  for (std::size_t k = 0; k < 3; ++k) state_.com_m[k] = com_m[k] - foot_m[k];
  const Vec3& rate_rad_s = base.angular_velocity_rad_s;
  return state_.com_m[2] > lowest_com_m && std::isfinite(state_.com_m[0]) && std::isfinite(state_.com_m[1]) &&
         std::isfinite(rate_rad_s[0]) && std::isfinite(rate_rad_s[1]);
}

void StanceLeg::load(const BaseStatus& base) noexcept {
  const Config& c = config_;
  State& s = state_;
  const auto [roll_Nm, pitch_Nm] = c.trunk.moment_Nm(base);
  s.turn_x_Nm = roll_Nm;
  s.turn_y_Nm = pitch_Nm;
  const double height_m = s.com_m[2] + c.sole_m, most_N = c.grip * weight_N_;
  s.force_N[0] = std::clamp((weight_N_ * (s.com_m[0] - c.pressure_x_m) - s.turn_y_Nm) / height_m, -most_N, most_N);
  s.force_N[1] = std::clamp((weight_N_ * s.com_m[1] + s.turn_x_Nm) / height_m, -most_N, most_N);
  s.force_N[2] = weight_N_;
  const Vec3& foot_m = kinematics_.link(foot_).position_m;
  leg_.update(kinematics_, s.force_N, {foot_m[0] + c.pressure_x_m, foot_m[1], foot_m[2] - c.sole_m});
  for (const LegLoad::Bearing& bearing : leg_.bearings()) {
    for (BalanceJoint& part : parts_) {
      if (part.axis.joint == bearing.joint) part.wanted_Nm = bearing.effort_Nm;
    }
  }
}

void StanceLeg::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool stands = measure(input);
  state_.share = stands ? std::min(1.0, state_.share + input.dt_s / std::max(config_.rise_s, input.dt_s)) : 0;
  if (stands) load(input.status.base);
  for (BalanceJoint& part : parts_) part.give(state_.share, stands, effort_share, 0, input.dt_s, actuation);
}

std::unique_ptr<ControlObject> make_stance_leg(const ObjectSetup& setup) { return std::make_unique<StanceLeg>(setup); }

}  // namespace kadans
