#include "support_forces.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "control/option_link.h"

namespace kadans {
namespace {

using Wrench = Eigen::Matrix<double, 6, 1>;
using WrenchMap = Eigen::Matrix<double, 6, 3>;

constexpr double damping = 1e-6;  // of the least squares: what two feet cannot do is not asked of them with all might
constexpr double effort_share_max = 0.9;  // of a joint's; the posture adds its own

// What a force at the point does, moments in units of `length_m`.
WrenchMap map_of(const Vec3& p, double length_m) noexcept {
  WrenchMap map = WrenchMap::Zero();
  map.topRows<3>().setIdentity();
  map.bottomRows<3>() << 0, -p[2], p[1], p[2], 0, -p[0], -p[1], p[0], 0;
  map.bottomRows<3>() /= length_m;
  return map;
}

double mean_length_m(std::span<const Vec3> points_m) noexcept {
  double sum_m2 = 0;
  for (const Vec3& p : points_m) sum_m2 += p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  return std::sqrt(std::max(sum_m2 / static_cast<double>(points_m.size()), 1e-6));
}

}  // namespace

void distribute(std::span<const Vec3> points_m, const Vec3& force_N, const Vec3& moment_Nm, double grip,
                std::span<Vec3> forces_N) noexcept {
  const double length_m = mean_length_m(points_m);
  Wrench wanted;
  wanted << force_N[0], force_N[1], force_N[2], moment_Nm[0] / length_m, moment_Nm[1] / length_m,
      moment_Nm[2] / length_m;
  std::array<bool, max_feet> bears{};
  std::array<WrenchMap, max_feet> maps;
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    bears[i] = true;
    maps[i] = map_of(points_m[i], length_m);
  }
  for (std::size_t round = 0; round < points_m.size(); ++round) {
    Eigen::Matrix<double, 6, 6> together = Eigen::Matrix<double, 6, 6>::Identity() * damping;
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      if (bears[i]) together += maps[i] * maps[i].transpose();
    }
    const Wrench multipliers = together.ldlt().solve(wanted);
    std::size_t worst = points_m.size();
    for (std::size_t i = 0; i < points_m.size(); ++i) {
      const Eigen::Vector3d force =
          bears[i] ? Eigen::Vector3d(maps[i].transpose() * multipliers) : Eigen::Vector3d::Zero();
      forces_N[i] = {force[0], force[1], force[2]};
      if (force[2] < 0 && (worst == points_m.size() || force[2] < forces_N[worst][2])) worst = i;
    }
    if (worst == points_m.size()) break;
    bears[worst] = false;
    forces_N[worst] = {};
  }
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    Vec3& force = forces_N[i];
    force[2] = std::clamp(force[2], 0.0, std::max(force_N[2], 0.0));
    const double along_N = std::hypot(force[0], force[1]), most_N = grip * force[2];
    if (along_N <= most_N) continue;
    force[0] *= most_N / along_N;
    force[1] *= most_N / along_N;
  }
}

namespace {

std::vector<std::size_t> feet_of(const ObjectSetup& setup) {
  const std::string* const names = setup.options.find("feet");
  if (names == nullptr) throw OptionError("feet", "it needs the option 'feet': the links that stand");
  std::vector<std::size_t> feet;
  std::istringstream words(*names);
  for (std::string name; words >> name;) {
    const std::size_t link = link_named(setup, "feet", name);
    if (link == 0) throw OptionError("feet", "'" + name + "' is the base: no leg leads to it");
    if (std::ranges::find(feet, link) != feet.end()) throw OptionError("feet", "'" + name + "' is named twice");
    feet.push_back(link);
  }
  if (feet.size() < SupportForces::least_feet || feet.size() > max_feet)
    throw OptionError("feet", std::to_string(feet.size()) + " feet are named, 3 to " + std::to_string(max_feet) +
                                  " are needed; a robot on two has the type stance");
  return feet;
}

}  // namespace

SupportForces::SupportForces(const ObjectSetup& setup)
    : body_(setup.model), weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {
  for (const std::size_t link : feet_of(setup))
    feet_.push_back({.link = link, .name = setup.model.links[link].name, .load = LegLoad(setup.model, link)});
  const auto bears = [this](std::size_t joint) {
    return std::ranges::any_of(feet_, [joint](const Foot& foot) { return foot.load.bears(joint); });
  };
  for (JointAxis& axis : joint_axes(setup)) {
    if (!bears(axis.joint))
      throw std::invalid_argument("joint " + axis.name + " has no part in support: no foot hangs on it");
    parts_.push_back({.axis = std::move(axis)});
  }
}

void SupportForces::declare(Declaration& d) {
  Config& c = config_;
  d.tunable("share", "", 0, 1, c.share, "Share of all its torques.");
  d.tunable("offset_x_m", "m", -0.5, 0.5, c.offset_x_m, "Where the divergent component shall be, forward.");
  d.tunable("offset_y_m", "m", -0.5, 0.5, c.offset_y_m, "The same, to the left.");
  d.tunable("pull", "", 0, 10, c.pull, "Shift of the pressure per error.");
  c.trunk.declare(d, TrunkRighting::Leans::anyhow, {5000, 500});
  d.tunable("turn_Nms_per_rad", "Nms/rad", 0, 500, c.turn_Nms_per_rad, "Damps turning about the vertical.");
  d.tunable("height_m", "m", 0, 2, c.height_m, "Of the centre of mass over the feet.");
  d.tunable("height_N_per_m", "N/m", 0, 20000, c.height_N_per_m, "Lifts it there.");
  d.tunable("height_Ns_per_m", "Ns/m", 0, 5000, c.height_Ns_per_m, "Damps it.");
  d.tunable("lift_max", "", 0, 1, c.lift_max, "Most of both, per weight.");
  d.tunable("grip", "", 0, 2, c.grip, "Most of a foot's force along the ground, per force on it.");
  d.tunable("smooth_s", "s", 0, 0.1, c.smooth_s, "Time constant of the torques' low pass; 0: none.");
  for (Foot& foot : feet_) {
    constexpr std::array<const char*, 3> axes{"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k)
      d.tunable(foot.name + "." + axes[k] + "_m", "m", -2, 2, foot.at_m[k],
                "Where it touches the ground, in the link's frame.");
  }
  declare_signals(d);
}

void SupportForces::declare_signals(Declaration& d) {
  const State& s = state_;
  d.signal({"dcm_x_m", "m", "Divergent component of motion, forward of the feet's middle."}, &s.dcm_x_m);
  d.signal({"dcm_y_m", "m", "Divergent component of motion, left of the feet's middle."}, &s.dcm_y_m);
  d.signal({"cop_x_m", "m", "Centre of pressure that is wanted, forward of the feet's middle."}, &s.cop_x_m);
  d.signal({"cop_y_m", "m", "Centre of pressure that is wanted, left of the feet's middle."}, &s.cop_y_m);
  d.signal({"force_x_N", "N", "Force of the ground that is wanted, forward."}, &s.force_N[0]);
  d.signal({"force_y_N", "N", "Force of the ground that is wanted, to the left."}, &s.force_N[1]);
  d.signal({"force_z_N", "N", "Force of the ground that is wanted, upward."}, &s.force_N[2]);
  d.signal({"turn_x_Nm", "Nm", "Moment about the centre of mass, to the right."}, &s.moment_Nm[0]);
  d.signal({"turn_y_Nm", "Nm", "Moment about the centre of mass, forward."}, &s.moment_Nm[1]);
  d.signal({"share", "", "Share of its torques that acts."}, &s.share);
  for (Foot& foot : feet_)
    d.signal({foot.name + ".force_z_N", "N", "Force on the foot that is wanted, upward."}, &foot.force_N[2]);
  declare_efforts(d);
}

// False when it does not stand, or something is not measured.
bool SupportForces::measure(const ControlInput& input) noexcept {
  const BaseStatus& base = input.status.base;
  body_.update(input, from_roll_pitch_yaw(base.roll_rad, base.pitch_rad, 0));
  com_m_ = body_.com_m();
  velocity_m_s_ = body_.com_velocity_m_s();
  const double share = 1 / static_cast<double>(feet_.size());
  for (Foot& foot : feet_) {
    foot.point_m = transform(body_.kinematics().link(foot.link), foot.at_m);
    const Vec3 moves_m_s = body_.velocity_m_s(foot.link, foot.point_m);
    for (std::size_t k = 0; k < 3; ++k) {
      com_m_[k] -= share * foot.point_m[k];
      velocity_m_s_[k] -= share * moves_m_s[k];
    }
  }
  const double time_s = std::sqrt(std::max(com_m_[2], lowest_com_m) / gravity_of_balance_m_s2);
  state_.dcm_x_m = com_m_[0] + time_s * velocity_m_s_[0];
  state_.dcm_y_m = com_m_[1] + time_s * velocity_m_s_[1];
  return com_m_[2] > lowest_com_m && std::isfinite(state_.dcm_x_m) && std::isfinite(state_.dcm_y_m);
}

void SupportForces::find_force(const BaseStatus& base) noexcept {
  const Config& c = config_;
  State& s = state_;
  Vec3 low{}, high{};  // how far the feet reach from their middle
  const Vec3& com = body_.com_m();
  for (const Foot& foot : feet_) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double at_m = foot.point_m[k] - (com[k] - com_m_[k]);
      low[k] = std::min(low[k], at_m);
      high[k] = std::max(high[k], at_m);
    }
  }
  s.cop_x_m = std::clamp(c.offset_x_m + c.pull * (s.dcm_x_m - c.offset_x_m), low[0], high[0]);
  s.cop_y_m = std::clamp(c.offset_y_m + c.pull * (s.dcm_y_m - c.offset_y_m), low[1], high[1]);
  const double lift_N = c.height_N_per_m * (c.height_m - com_m_[2]) - c.height_Ns_per_m * velocity_m_s_[2];
  s.force_N[2] = weight_N_ + std::clamp(lift_N, -c.lift_max * weight_N_, c.lift_max * weight_N_);
  const double most_N = c.grip * s.force_N[2];
  s.force_N[0] = std::clamp(weight_N_ * (com_m_[0] - s.cop_x_m) / com_m_[2], -most_N, most_N);
  s.force_N[1] = std::clamp(weight_N_ * (com_m_[1] - s.cop_y_m) / com_m_[2], -most_N, most_N);
  const auto [roll_Nm, pitch_Nm] = c.trunk.moment_Nm(base);
  s.moment_Nm = {roll_Nm, pitch_Nm, -c.turn_Nms_per_rad * base.angular_velocity_rad_s[2]};
}

void SupportForces::load_legs() noexcept {
  const Vec3& com = body_.com_m();
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) points_m_[i][k] = feet_[i].point_m[k] - com[k];
  }
  distribute({points_m_.data(), feet_.size()}, state_.force_N, state_.moment_Nm, config_.grip,
             {forces_N_.data(), feet_.size()});
  for (BalanceJoint& part : parts_) part.wanted_Nm = 0;
  for (std::size_t i = 0; i < feet_.size(); ++i) {
    Foot& foot = feet_[i];
    foot.force_N = forces_N_[i];
    foot.load.update(body_.kinematics(), foot.force_N, foot.point_m);
    for (const LegLoad::Bearing& bearing : foot.load.bearings()) {
      for (BalanceJoint& part : parts_) {
        if (part.axis.joint == bearing.joint) part.wanted_Nm += bearing.effort_Nm;
      }
    }
  }
}

void SupportForces::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool stands = measure(input);
  state_.share = faded_share(state_.share, config_.share, stands, input.dt_s);
  if (stands) {
    find_force(input.status.base);
    load_legs();
  }
  for (BalanceJoint& part : parts_)
    part.give(state_.share, stands, effort_share_max, config_.smooth_s, input.dt_s, actuation);
}

std::unique_ptr<ControlObject> make_support_forces(const ObjectSetup& setup) {
  return std::make_unique<SupportForces>(setup);
}

}  // namespace kadans
