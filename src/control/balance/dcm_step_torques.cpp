// The torques of DcmStep: of a leg that swings, of one that stands alone, of two that bear.
#include <algorithm>
#include <cmath>

#include "dcm_step.h"

namespace kadans {
namespace {

constexpr double rate_time_s = 0.006;  // low pass of the targets' rates
constexpr double alone_s = 0.03;       // in which a leg is taken to stand alone
constexpr double rate_max_rad_s = 6;
constexpr double edge_front_m = 0.14, edge_back_m = 0.08;  // of the sole
constexpr double torso_over_hips = 0.6;                    // share of the weight that stands on the hips

}  // namespace

DcmStep::DcmStep(const ObjectSetup& setup)
    : axes_(joint_axes(setup)),
      over_feet_(setup),
      legs_{Leg{.inverse = LegInverse(setup.model, axes_, "l")}, Leg{.inverse = LegInverse(setup.model, axes_, "r")}},
      weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {}

Vec3 DcmStep::hip(std::size_t leg) const noexcept { return rotate(over_feet_.upright(), legs_[leg].inverse.hip_m()); }

void DcmStep::aim(Leg& leg, const LegInverse::Angles& target_rad, double dt_s) noexcept {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const double rate_rad_s = (target_rad[i] - leg.target_rad[i]) / dt_s;
    const double limited_rad_s = std::clamp(rate_rad_s, -rate_max_rad_s, rate_max_rad_s);
    leg.rate_rad_s[i] += dt_s / rate_time_s * (limited_rad_s - leg.rate_rad_s[i]);
    leg.target_rad[i] = target_rad[i];
  }
}

DcmStep::Efforts DcmStep::spring(const Leg& leg, double share, const ControlInput& input) const noexcept {
  Efforts effort_Nm{};
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const JointState& joint = input.joints.joints[leg.inverse.axis(i).joint];
    effort_Nm[i] = share * config_.kp_Nm_per_rad[i] * (leg.target_rad[i] - joint.position_rad) +
                   config_.kd_Nms_per_rad[i] * (leg.rate_rad_s[i] - joint.velocity_rad_s);
  }
  return effort_Nm;
}

// What holds a leg whose foot bears force_N at the plan's centre of pressure: -(r x F) about each joint.
DcmStep::Efforts DcmStep::bearing(std::size_t i, double force_N, const ControlInput& input) const noexcept {
  const Leg& leg = legs_[i];
  const GroundPoint& in_sole = plan_.state().in_sole;
  const Vec3 hip_m = hip(i);
  const Vec3& foot_m = over_feet_.over(i).foot_m;
  const double thigh_rad =
      input.status.base.pitch_rad + input.joints.joints[leg.inverse.axis(hip_pitch).joint].position_rad;
  const double knee_x_m = hip_m[0] - leg.inverse.thigh_m() * std::sin(thigh_rad);
  const double at_x_m = foot_m[0] + in_sole.x_m, at_y_m = foot_m[1] + in_sole.y_m;
  const double ground_N = std::max(input.status.feet[i].force_N, 0.0);  // more would turn the foot about its edge
  const double ankle_Nm =
      std::clamp(force_N * in_sole.x_m, -ground_N * plan_config_.sole.heel_m, ground_N * plan_config_.sole.toe_m);
  return {0, -force_N * (at_y_m - hip_m[1]), force_N * (at_x_m - hip_m[0]), force_N * (at_x_m - knee_x_m),
          std::clamp(ankle_Nm, -config_.ankle_max_Nm, config_.ankle_max_Nm)};
}

// Of roll and pitch at a hip that alone holds the torso upright; the other leg's torques are known.
std::array<double, 2> DcmStep::upright(std::size_t i, const ControlInput& input) const noexcept {
  const Config& c = config_;
  const BaseStatus& base = input.status.base;
  const Vec3& w = base.angular_velocity_rad_s;
  const Vec3& com_m = over_feet_.com_m();
  const Vec3 hip_m = hip(i);
  const Efforts& other_Nm = legs_[1 - i].effort_Nm;
  return {c.torso_Nm_per_rad * base.roll_rad + c.torso_Nms_per_rad * w[0] -
              c.weight_share * weight_N_ * (com_m[1] - hip_m[1]) - c.counter_share * other_Nm[hip_roll],
          c.torso_Nm_per_rad * (base.pitch_rad - lean_rad_) + c.torso_Nms_per_rad * w[1] +
              torso_over_hips * weight_N_ * (com_m[0] - hip_m[0]) - c.counter_share * other_Nm[hip_pitch]};
}

// A leg whose foot shall be there, seen from the other foot as it is over the ground.
LegInverse::Angles DcmStep::reach(std::size_t i, const Vec3& way_m, const ControlInput& input) const noexcept {
  const DcmMeasure::OverFoot& other = over_feet_.over(1 - i);
  const Vec3& foot_m = other.foot_m;
  const Vec3 hip_m = hip(i);
  const double risen_m =
      std::max(-other.toe_up_m * edge_front_m, other.toe_up_m * edge_back_m);  // on its toes, or heel
  const Vec3 leg_m{foot_m[0] + way_m[0] - hip_m[0], foot_m[1] + way_m[1] - hip_m[1],
                   foot_m[2] + way_m[2] - hip_m[2] - risen_m};
  LegInverse::Angles target_rad =
      legs_[i].inverse.angles(rotate_inverse(over_feet_.upright(), leg_m), -over_feet_.yaw_rad());
  target_rad[ankle_pitch] -= input.status.base.pitch_rad;
  return target_rad;
}

void DcmStep::swing_torques(const ControlInput& input) noexcept {
  const Config& c = config_;
  const std::size_t a = plan_.state().stance, b = 1 - a;
  Leg& stance = legs_[a];
  Leg& swing = legs_[b];
  aim(swing, reach(b, plan_.other_foot(plan_config_), input), input.dt_s);
  swing.effort_Nm = spring(swing, 1, input);

  const double share = swing_way(plan_.state().time_s / plan_config_.swing_s);
  LegInverse::Angles held_rad = stance.landed_rad;
  held_rad[knee] += share * (c.stance_knee_rad - held_rad[knee]);
  held_rad[hip_yaw] *= 1 - share;
  aim(stance, held_rad, input.dt_s);
  const Efforts held_Nm = spring(stance, 1, input), borne_Nm = bearing(a, weight_N_, input);
  const auto [roll_Nm, pitch_Nm] = upright(a, input);
  stance.effort_Nm = {held_Nm[hip_yaw], roll_Nm, pitch_Nm, held_Nm[knee] + borne_Nm[knee], borne_Nm[ankle_pitch]};
}

void DcmStep::bearing_torques(const ControlInput& input) noexcept {
  const Config& c = config_;
  const StepPlan::State& s = plan_.state();
  const BaseStatus& base = input.status.base;
  const double pitch_Nm =
      c.torso_Nm_per_rad * (base.pitch_rad - lean_rad_) + c.torso_Nms_per_rad * base.angular_velocity_rad_s[1];
  const double left_N = std::max(input.status.feet[0].force_N, 0.0);
  const double right_N = std::max(input.status.feet[1].force_N, 0.0);
  const std::size_t light = left_N < right_N ? 0 : 1;
  const double least = std::min(left_N, right_N) / std::max(left_N + right_N, 1.0);
  alone_ += std::min(input.dt_s / alone_s, 1.0) * (std::clamp(2 - least / (0.5 * c.both_share), 0.0, 1.0) - alone_);
  for (std::size_t i = 0; i < 2; ++i) {
    Leg& leg = legs_[i];
    LegInverse::Angles target_rad = come_to_stance(i);
    if (i == light) {
      const LegInverse::Angles ground_rad = seek_ground(i, input);
      for (std::size_t j = 0; j < leg_joints; ++j) target_rad[j] += alone_ * (ground_rad[j] - target_rad[j]);
    }
    aim(leg, target_rad, input.dt_s);
    const double share = i == 1 ? s.right_share : 1 - s.right_share;
    const Efforts held_Nm = spring(leg, c.soft_share, input), borne_Nm = bearing(i, share * weight_N_, input);
    for (std::size_t j = 0; j < leg_joints; ++j) leg.effort_Nm[j] = held_Nm[j] + c.forward_share * borne_Nm[j];
    leg.effort_Nm[ankle_pitch] = held_Nm[ankle_pitch] + borne_Nm[ankle_pitch];
    leg.effort_Nm[hip_pitch] += c.bears_share * share * pitch_Nm;
  }
}

// From how it landed to the stance, its speed at the landing carried on.
LegInverse::Angles DcmStep::come_to_stance(std::size_t i) const noexcept {
  const StepPlan::State& s = plan_.state();
  const Leg& leg = legs_[i];
  const Vec3& com_m = over_feet_.com_m();
  const double x_m = s.goal.x_m - com_m[0], y_m = s.goal.y_m - com_m[1];  // of the base, over the stance foot
  const Quat leaning = from_roll_pitch_yaw(0, lean_rad_, 0);
  const Vec3 at_m = i == s.stance ? Vec3{} : s.from_m;
  const Vec3 hip_m = rotate(leaning, leg.inverse.hip_m());
  const Vec3 ankle_m{at_m[0] - x_m - hip_m[0], at_m[1] - y_m - hip_m[1], at_m[2] - config_.hip_height_m};
  LegInverse::Angles target_rad = leg.inverse.angles(rotate_inverse(leaning, ankle_m), 0);
  target_rad[ankle_pitch] -= lean_rad_;
  const double time = std::min(s.time_s / config_.come_s, 1.0);
  const double way = time * time * (3 - 2 * time), along_s = config_.come_s * time * (1 - time) * (1 - time);
  for (std::size_t j = 0; j < leg_joints; ++j)
    target_rad[j] = (1 - way) * leg.landed_rad[j] + along_s * leg.landed_rad_s[j] + way * target_rad[j];
  return target_rad;
}

// A foot that lost the ground looks for it where it was.
LegInverse::Angles DcmStep::seek_ground(std::size_t i, const ControlInput& input) const noexcept {
  const StepPlan::State& s = plan_.state();
  const double sign = i == s.stance ? -1 : 1;
  return reach(i, {sign * s.from_m[0], sign * s.from_m[1], sign * s.from_m[2] - config_.seek_m}, input);
}

}  // namespace kadans
