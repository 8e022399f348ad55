#include "stance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "dcm_measure.h"
#include "leg_parts.h"

namespace kadans {
namespace {

double along(const Vec3& a, const Vec3& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

LegLoad::LegLoad(const RobotModel& model, std::size_t foot) : model_(&model) {
  for (std::size_t link = foot; link != 0; link = model.joints[link - 1].parent) {
    bearings_.push_back({.joint = link - 1});
  }
}

bool LegLoad::bears(std::size_t joint) const noexcept {
  return std::ranges::any_of(bearings_, [joint](const Bearing& bearing) { return bearing.joint == joint; });
}

void LegLoad::update(const Kinematics& kinematics, const Vec3& force_N, const Vec3& point_m) noexcept {
  Vec3 force = force_N;
  Vec3 about_origin = cross(point_m, force_N);  // about the origin
  for (Bearing& bearing : bearings_) {
    const std::size_t link = bearing.joint + 1;
    const Pose& pose = kinematics.link(link);
    const Inertia& inertia = model_->links[link].inertia;
    const Vec3 weight{0, 0, -gravity_of_balance_m_s2 * inertia.mass_kg};
    const Vec3 weight_moment = cross(transform(pose, inertia.com_m), weight);
    for (std::size_t k = 0; k < 3; ++k) {
      force[k] += weight[k];
      about_origin[k] += weight_moment[k];
    }
    const Vec3 shift = cross(pose.position_m, force);
    const Vec3 about{about_origin[0] - shift[0], about_origin[1] - shift[1], about_origin[2] - shift[2]};
    bearing.effort_Nm = -along(rotate(pose.orientation, model_->joints[bearing.joint].axis), about);
  }
}

namespace {

constexpr double most_effort = 0.9;   // of a joint's; the posture adds its own
constexpr double narrowest_m = 0.02;  // feet apart by less do not share by p_y

}  // namespace

Stance::Stance(const ObjectSetup& setup)
    : standing_(setup),
      legs_{LegLoad(setup.model, standing_.feet()[0]), LegLoad(setup.model, standing_.feet()[1])},
      weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {
  const std::vector<JointPart> parts = leg_parts(setup.model, standing_.feet());
  for (JointAxis& axis : joint_axes(setup)) {
    const JointPart& part = parts[axis.joint];
    if (part.part != LegPart::swing && !legs_[0].bears(axis.joint) && !legs_[1].bears(axis.joint)) {
      throw std::invalid_argument("joint " + axis.name +
                                  " has no part in a stance: no foot hangs on it, and it is no shoulder that turns "
                                  "about y");
    }
    parts_.push_back({.axis = std::move(axis), .in_leg = part});
  }
}

void Stance::declare(Declaration& d) {
  declare_pressure(d);
  declare_trunk(d);
  declare_signals(d);
}

void Stance::declare_pressure(Declaration& d) {
  Config& c = config_;
  d.tunable("share", "", 0, 1, c.share, "Share of all its torques.");
  d.tunable("offset_x_m", "m", -0.2, 0.2, c.offset_x_m, "Where the divergent component shall be, forward.");
  d.tunable("offset_y_m", "m", -0.2, 0.2, c.offset_y_m, "The same, to the left.");
  d.tunable("pull_x", "", 0, 10, c.pull_x, "Shift of the pressure per error forward.");
  d.tunable("pull_y", "", 0, 10, c.pull_y, "Shift of the pressure per error to the side.");
  d.tunable("need", "", 1, 10, c.need, "Of pull, what the trunk has to bow for.");
  d.tunable("toe_m", "m", 0, 0.5, c.toe_m, "How far before its frame a foot may be pressed.");
  d.tunable("heel_m", "m", 0, 0.5, c.heel_m, "How far behind its frame a foot may be pressed.");
  d.tunable("flat_m_per_rad", "m/rad", 0, 5, c.flat_m_per_rad, "Pressure shifts back on a foot that tips.");
  d.tunable("sole_m", "m", 0, 0.5, c.sole_m, "How far the sole is below a foot's frame.");
  d.tunable("side_m", "m", 0, 0.5, c.side_m, "How far out of the feet's frames the pressure may go.");
  d.tunable("grip", "", 0, 2, c.grip, "Most of the force along the ground, per weight.");
}

void Stance::declare_trunk(Declaration& d) {
  Config& c = config_;
  c.trunk.declare(d, TrunkRighting::Leans::forward_only, {2000, 200});
  d.tunable("height_m", "m", 0, 2, c.height_m, "Of the centre of mass over the feet's frames.");
  d.tunable("height_N_per_m", "N/m", 0, 20000, c.height_N_per_m, "Lifts it there.");
  d.tunable("height_Ns_per_m", "Ns/m", 0, 2000, c.height_Ns_per_m, "Damps it.");
  d.tunable("lift_N_per_m", "N/m", 0, 5000, c.lift_N_per_m, "Harder on the ground, per distance of the pressure.");
  d.tunable("lift_max", "", 0, 1, c.lift_max, "Most of both, per weight.");
  d.tunable("turn_max_Nm", "Nm", 0, 200, c.turn_max_Nm, "Bound of the moment that turns the trunk.");
  d.tunable("arm_Nm_per_m", "Nm/m", 0, 1000, c.arm_Nm_per_m, "Torque of a shoulder, per pressure beyond the soles.");
  d.tunable("arm_from_m", "m", 0, 1, c.arm_from_m, "How far beyond that begins.");
  d.tunable("trust_per_s", "1/s", 0, 1000, c.trust_per_s, "Rate at which xi follows what is measured.");
  d.tunable("smooth_s", "s", 0, 0.1, c.smooth_s, "Time constant of the torques' low pass; 0: none.");
}

void Stance::declare_signals(Declaration& d) {
  const State& s = state_;
  d.signal({"dcm_x_m", "m", "Divergent component of motion, forward of the feet's middle."}, &s.dcm_x_m);
  d.signal({"dcm_y_m", "m", "Divergent component of motion, left of the feet's middle."}, &s.dcm_y_m);
  d.signal({"cop_x_m", "m", "Centre of pressure that is wanted, forward of the feet's middle."}, &s.cop_x_m);
  d.signal({"cop_y_m", "m", "Centre of pressure that is wanted, left of the feet's middle."}, &s.cop_y_m);
  d.signal({"turn_x_Nm", "Nm", "Moment that turns the robot, to the right."}, &s.turn_x_Nm);
  d.signal({"turn_y_Nm", "Nm", "Moment that turns the robot, forward."}, &s.turn_y_Nm);
  d.signal({"beyond_x_m", "m", "How far before or behind the soles the pressure would have to be."}, &s.beyond_x_m);
  d.signal({"left", "", "Share of the weight for the left foot."}, &s.left);
  d.signal({"force_x_N", "N", "Force of the ground that is wanted, forward."}, &s.force_N[0]);
  d.signal({"force_y_N", "N", "Force of the ground that is wanted, to the left."}, &s.force_N[1]);
  d.signal({"force_z_N", "N", "Force of the ground that is wanted, upward."}, &s.force_N[2]);
  d.signal({"share", "", "Share of its torques that acts."}, &s.share);
  declare_efforts(d);
}

// xi follows its law from the measured pressure, and the measurement as far as that is trusted: the velocity in it has
// the noise of encoders.
void Stance::look(const ControlInput& input) noexcept {
  State& s = state_;
  const double trust = config_.trust_per_s * input.dt_s;
  const std::array<double, 2> measured{standing_.dcm_x_m(), standing_.dcm_y_m()};
  if (!(trust < 1) || !s.follows) {
    s.dcm_x_m = measured[0];
    s.dcm_y_m = measured[1];
    s.follows = true;
    return;
  }
  const Vec3& left = standing_.kinematics().link(standing_.feet()[0]).position_m;
  const Vec3& right = standing_.kinematics().link(standing_.feet()[1]).position_m;
  const auto& feet = input.status.feet;
  const double left_N = std::max(feet[0].force_N, 0.0), right_N = std::max(feet[1].force_N, 0.0);
  const double share = left_N + right_N > 1 ? left_N / (left_N + right_N) : 0.5;
  const double p_x_m = share * feet[0].cop_x_m + (1 - share) * feet[1].cop_x_m + (share - 0.5) * (left[0] - right[0]);
  const double p_y_m = share * feet[0].cop_y_m + (1 - share) * feet[1].cop_y_m + (share - 0.5) * (left[1] - right[1]);
  const double fall = input.dt_s * std::sqrt(gravity_of_balance_m_s2 / std::max(standing_.com_m()[2], lowest_com_m));
  s.dcm_x_m += fall * (s.dcm_x_m - p_x_m - s.turn_y_Nm / weight_N_) + trust * (measured[0] - s.dcm_x_m);
  s.dcm_y_m += fall * (s.dcm_y_m - p_y_m + s.turn_x_Nm / weight_N_) + trust * (measured[1] - s.dcm_y_m);
}

void Stance::find_pressure(const BaseStatus& base) noexcept {
  const Config& c = config_;
  State& s = state_;
  const Vec3& left = standing_.kinematics().link(standing_.feet()[0]).position_m;
  const Vec3& right = standing_.kinematics().link(standing_.feet()[1]).position_m;
  const double apart_m = std::max(left[1] - right[1], narrowest_m), ahead_m = left[0] - right[0];
  const std::array<double, 2> righting = c.trunk.moment_Nm(base);

  const double reach_m = apart_m / 2 + c.side_m;
  const Answer side = answer(s.dcm_y_m, c.offset_y_m, c.pull_y, {-reach_m, reach_m}, -righting[0]);
  s.cop_y_m = side.pressure_m;
  s.turn_x_Nm = -side.turn_Nm;
  s.left = std::clamp(0.5 + s.cop_y_m / apart_m, 0.0, 1.0);

  const double between_m = (s.left - 0.5) * ahead_m;
  const Answer ahead =
      answer(s.dcm_x_m, c.offset_x_m, c.pull_x, {between_m - c.heel_m, between_m + c.toe_m}, righting[1]);
  s.cop_x_m = ahead.pressure_m;
  s.turn_y_Nm = ahead.turn_Nm;
  s.beyond_x_m = ahead.beyond_m;
}

// d xi / dt = w0 (xi - p - L / (m g)): a moment on the trunk does what a shift of the pressure does. So L may right the
// trunk as far as the soles make up for it, and has to bow it where they do not reach.
Stance::Answer Stance::answer(double dcm_m, double rest_m, double pull, const std::array<double, 2>& sole_m,
                              double righting_Nm) const noexcept {
  const double need_m = rest_m + config_.need * (dcm_m - rest_m);
  const double least_Nm = weight_N_ * (need_m - sole_m[1]), most_Nm = weight_N_ * (need_m - sole_m[0]);
  const double turn_Nm =
      std::clamp(std::clamp(righting_Nm, least_Nm, most_Nm), -config_.turn_max_Nm, config_.turn_max_Nm);
  const double wanted_m = rest_m + pull * (dcm_m - rest_m) - turn_Nm / weight_N_;
  const double pressure_m = std::clamp(wanted_m, sole_m[0], sole_m[1]);
  return {.pressure_m = pressure_m, .beyond_m = wanted_m - pressure_m, .turn_Nm = turn_Nm};
}

void Stance::find_force() noexcept {
  const Config& c = config_;
  State& s = state_;
  const Vec3& com = standing_.com_m();
  const double braking_m = std::hypot(s.cop_x_m - com[0], s.cop_y_m - com[1]);
  const double lift_N = c.lift_N_per_m * braking_m + c.height_N_per_m * (c.height_m - com[2]) -
                        c.height_Ns_per_m * standing_.velocity_m_s()[2];
  const double height_m = com[2] + c.sole_m;
  s.force_N[2] = weight_N_ + std::clamp(lift_N, -c.lift_max * weight_N_, c.lift_max * weight_N_);
  const double most_N = c.grip * s.force_N[2];
  s.force_N[0] = std::clamp((s.force_N[2] * (com[0] - s.cop_x_m) - s.turn_y_Nm) / height_m, -most_N, most_N);
  s.force_N[1] = std::clamp((s.force_N[2] * (com[1] - s.cop_y_m) + s.turn_x_Nm) / height_m, -most_N, most_N);
}

void Stance::load(std::size_t side, double share) noexcept {
  const State& s = state_;
  const Pose& foot = standing_.kinematics().link(standing_.feet()[side]);
  const Vec3& ankle = foot.position_m;
  const Vec3& other = standing_.kinematics().link(standing_.feet()[1 - side]).position_m;
  const double between_m = (share - 0.5) * (ankle[0] - other[0]);
  const double tipped_rad = -std::asin(std::clamp(rotate(foot.orientation, {1, 0, 0})[2], -1.0, 1.0));
  const double pressed_m = s.cop_x_m - between_m - config_.flat_m_per_rad * tipped_rad;
  const Vec3 force{share * s.force_N[0], share * s.force_N[1], share * s.force_N[2]};
  legs_[side].update(standing_.kinematics(), force, {ankle[0] + pressed_m, ankle[1], ankle[2] - config_.sole_m});
  for (const LegLoad::Bearing& bearing : legs_[side].bearings()) {
    for (BalanceJoint& part : parts_) {
      if (part.axis.joint == bearing.joint) part.wanted_Nm = bearing.effort_Nm;
    }
  }
}

void Stance::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool stands = standing_.update(input);
  state_.share = faded_share(state_.share, config_.share, stands, input.dt_s);
  state_.follows = state_.follows && stands;
  if (stands) {
    look(input);
    find_pressure(input.status.base);
    find_force();
    load(0, state_.left);
    load(1, 1 - state_.left);
  }
  const State& s = state_;
  const double arm_m = config_.arm_from_m;
  for (BalanceJoint& part : parts_) {
    if (part.in_leg.part == LegPart::swing)
      part.wanted_Nm =
          part.in_leg.sign * config_.arm_Nm_per_m * (s.beyond_x_m - std::clamp(s.beyond_x_m, -arm_m, arm_m));
    part.give(s.share, stands, most_effort, config_.smooth_s, input.dt_s, actuation);
  }
}

std::unique_ptr<ControlObject> make_stance(const ObjectSetup& setup) { return std::make_unique<Stance>(setup); }

}  // namespace kadans
