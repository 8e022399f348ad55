#include "dcm_step.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "leg_parts.h"

namespace kadans {
namespace {

constexpr double straightest_knee_rad = 0.06, most_bent_knee_rad = 2.2;

double distance_m(double thigh_m, double shank_m, double knee_rad) {
  return std::sqrt(thigh_m * thigh_m + shank_m * shank_m + 2 * thigh_m * shank_m * std::cos(knee_rad));
}

}  // namespace

LegInverse::LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, std::size_t foot) {
  constexpr std::array<LegPart, leg_joints> wanted{LegPart::hip_yaw, LegPart::hip_roll, LegPart::hip_pitch,
                                                   LegPart::knee, LegPart::ankle_pitch};
  const std::vector<JointPart> parts = leg_parts(model, {&foot, 1});
  const std::string leg = "the leg of " + model.links[foot].name;
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const auto found = std::ranges::find_if(axes, [&](const JointAxis& a) { return parts[a.joint].part == wanted[i]; });
    if (found == axes.end()) throw std::invalid_argument(leg + " needs a joint as " + leg_joint_names[i]);
    if (parts[found->joint].sign < 0)
      throw std::invalid_argument(leg + ": joint " + found->name + " turns the other way; z, x, y, y, y are needed");
    if (i > 0 && found->joint < axes_[i - 1].joint)
      throw std::invalid_argument(leg + ": joint " + found->name + " comes before " + axes_[i - 1].name +
                                  "; from the hip on, z, x, y, y, y are needed");
    axes_[i] = *found;
  }
  const auto origin_m = [&](LegJoint joint) { return model.joints[axes_[joint].joint].origin.position_m; };
  hip_m_ = origin_m(hip_yaw);
  thigh_m_ = -origin_m(knee)[2];
  shank_m_ = -origin_m(ankle_pitch)[2];
  if (!(thigh_m_ > 0 && shank_m_ > 0)) throw std::invalid_argument("a leg's knee and ankle lie below its hip");
  longest_m_ = distance_m(thigh_m_, shank_m_, straightest_knee_rad);
  shortest_m_ = distance_m(thigh_m_, shank_m_, most_bent_knee_rad);
}

LegInverse::Angles LegInverse::angles(const Vec3& ankle_m, double yaw_rad) const noexcept {
  return angles(ankle_m, yaw_rad, longest_m_);
}

LegInverse::Angles LegInverse::angles(const Vec3& ankle_m, double yaw_rad, double longest_m) const noexcept {
  const double x_m = std::cos(yaw_rad) * ankle_m[0] + std::sin(yaw_rad) * ankle_m[1];
  const double y_m = std::cos(yaw_rad) * ankle_m[1] - std::sin(yaw_rad) * ankle_m[0];
  const double down_m = std::hypot(y_m, ankle_m[2]);
  const double reach_m = std::clamp(std::min(std::hypot(x_m, down_m), longest_m), shortest_m_, longest_m_);
  const double cosine = (reach_m * reach_m - thigh_m_ * thigh_m_ - shank_m_ * shank_m_) / (2 * thigh_m_ * shank_m_);
  const double bend_rad = std::acos(std::clamp(cosine, -1.0, 1.0));
  const double fore_rad = std::atan2(shank_m_ * std::sin(bend_rad), thigh_m_ + shank_m_ * std::cos(bend_rad));
  const double pitch_rad = std::atan2(-x_m, down_m) - fore_rad;
  return {yaw_rad, std::atan2(y_m, -ankle_m[2]), pitch_rad, bend_rad, -(pitch_rad + bend_rad)};
}

namespace {

constexpr double rate_time_s = 0.006;  // low pass of the targets' rates
constexpr double alone_s = 0.03;       // in which a leg is taken to stand alone
constexpr double rate_max_rad_s = 6;
constexpr double edge_front_m = 0.14, edge_back_m = 0.08;  // of the sole
constexpr double torso_over_hips = 0.6;                    // share of the weight that stands on the hips

}  // namespace

void LegGains::declare(Declaration& d) {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const std::string name = leg_joint_names[i];
    d.parameter({name + ".kp_Nm_per_rad", "Nm/rad", 0, 2000, kp_Nm_per_rad[i], "Torque per position error."},
                &kp_Nm_per_rad[i]);
    d.parameter({name + ".kd_Nms_per_rad", "Nm s/rad", 0, 200, kd_Nms_per_rad[i], "Torque per velocity error."},
                &kd_Nms_per_rad[i]);
  }
}

void LedLeg::declare_signals(Declaration& d) {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    d.signal({inverse.axis(i).name + ".target_rad", "rad", "Where it shall be."}, &target_rad[i]);
    d.signal({inverse.axis(i).name + ".effort_Nm", "Nm", "Torque asked for."}, &effort_Nm[i]);
  }
}

void LedLeg::aim(const LegInverse::Angles& new_target_rad, double rate_max_rad_s, double dt_s) noexcept {
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const double step_rad_s = (new_target_rad[i] - target_rad[i]) / dt_s;
    const double limited_rad_s = std::clamp(step_rad_s, -rate_max_rad_s, rate_max_rad_s);
    rate_rad_s[i] += dt_s / rate_time_s * (limited_rad_s - rate_rad_s[i]);
    target_rad[i] = new_target_rad[i];
  }
}

LegInverse::Angles LedLeg::spring(const LegGains& gains, double share, const ControlInput& input) const noexcept {
  LegInverse::Angles torque_Nm{};
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const JointState& joint = input.joints.joints[inverse.axis(i).joint];
    torque_Nm[i] = share * gains.kp_Nm_per_rad[i] * (target_rad[i] - joint.position_rad) +
                   gains.kd_Nms_per_rad[i] * (rate_rad_s[i] - joint.velocity_rad_s);
  }
  return torque_Nm;
}

void DcmStep::declare(Declaration& d) {
  Config& c = config_;
  d.parameter({"enabled", "", 0, 1, 0, "1: it may step; 0: it releases its joints."}, &c.enabled);
  d.parameter({"tilt_max_rad", "rad", 0, 1.5, 0.7, "Tilt of the trunk beyond which it gives up."}, &c.tilt_max_rad);
  d.parameter({"hip_height_m", "m", 0.1, 2, 0.5, "Of the hips over the ankles, both bearing."}, &c.hip_height_m);
  d.parameter({"stance_knee_rad", "rad", 0.05, 2, 0.5, "Of the leg that stands alone."}, &c.stance_knee_rad);
  d.parameter({"torso_Nm_per_rad", "Nm/rad", 0, 2000, 250, "Torque of the stance hip per lean of the torso."},
              &c.torso_Nm_per_rad);
  d.parameter({"torso_Nms_per_rad", "Nm s/rad", 0, 200, 15, "The same, per rate of turning."}, &c.torso_Nms_per_rad);
  d.parameter({"bears_share", "", 0, 1, 0.3, "Share of these while both feet bear."}, &c.bears_share);
  d.parameter({"lean_s", "s", 0.01, 10, 0.5, "Time constant in which the torso comes upright."}, &c.lean_s);
  d.parameter({"weight_share", "", 0, 1.5, 0.85, "Share of the weight that hangs beside the stance hip."},
              &c.weight_share);
  d.parameter({"counter_share", "", 0, 1, 0.8, "Share of the swing hip's torque that the stance hip takes."},
              &c.counter_share);
  d.parameter({"ankle_max_Nm", "Nm", 0, 50, 16, "Bound of an ankle's torque that puts the pressure."}, &c.ankle_max_Nm);
  d.parameter({"ankle_smooth_s", "s", 0, 0.1, 0.005, "Time constant of the ankles' low pass."}, &c.ankle_smooth_s);
  d.parameter({"forward_share", "", 0, 1, 0.5, "Share of what bears the weight as feed-forward."}, &c.forward_share);
  d.parameter({"soft_share", "", 0.05, 2, 0.6, "Share of kp while both feet bear."}, &c.soft_share);
  d.parameter({"both_share", "", 0.001, 0.5, 0.1, "Share of the load, below which a foot counts as off the ground."},
              &c.both_share);
  d.parameter({"seek_m", "m", 0, 0.1, 0.01, "How deep a foot that lost the ground looks for it."}, &c.seek_m);
  d.parameter({"come_s", "s", 0.05, 5, 0.4, "From a landing to the stance."}, &c.come_s);
  d.parameter({"carry", "", 0, 1, 0.7, "Share of the speeds of the landing that its motion begins with."}, &c.carry);
  config_.gains.declare(d);
  declare_plan(d);
  declare_signals(d);
}

void DcmStep::declare_plan(Declaration& d) {
  StepPlan::Config& c = plan_config_;
  d.parameter({"heel_m", "m", 0.001, 0.5, 0.07, "Of the sole that may bear, behind the foot's frame."}, &c.sole.heel_m);
  d.parameter({"toe_m", "m", 0.001, 0.5, 0.12, "Before it."}, &c.sole.toe_m);
  d.parameter({"half_width_m", "m", 0, 0.5, 0.03, "To either side of it."}, &c.sole.half_width_m);
  d.parameter({"front_m", "m", -0.5, 0.5, 0.1, "Steps when xi is so far before the foot in front."}, &c.front_m);
  d.parameter({"back_m", "m", -0.5, 0.5, 0.07, "Steps when xi is so far behind the foot behind."}, &c.back_m);
  d.parameter({"ahead_s", "s", 0, 0.2, 0.02, "How far xi is looked ahead."}, &c.ahead_s);
  d.parameter({"again_m", "m", 0, 0.5, 0.03, "Steps again when xi is so far beyond the soles."}, &c.again_m);
  d.parameter({"settle_s", "s", 0, 2, 0.1, "After a landing, before the next step."}, &c.settle_s);
  d.parameter({"swing_s", "s", 0.1, 2, 0.26, "Time of a swing."}, &c.swing_s);
  d.parameter({"lift_m", "m", 0, 0.3, 0.03, "Height of a swing."}, &c.lift_m);
  d.parameter({"extra_x_m", "m", -0.2, 0.2, 0.05, "Further than needed, along."}, &c.extra_x_m);
  d.parameter({"extra_y_m", "m", -0.2, 0.2, 0.03, "Further than needed, to the side."}, &c.extra_y_m);
  d.parameter({"apart_min_m", "m", 0, 1, 0.17, "Least distance of the feet, to the side."}, &c.apart_min_m);
  d.parameter({"apart_max_m", "m", 0, 1, 0.42, "Largest distance of the feet, to the side."}, &c.apart_max_m);
  d.parameter({"reach_m", "m", 0, 1, 0.4, "Longest step."}, &c.reach_m);
  d.parameter({"pressure_gain", "", 0, 10, 1, "Shift of the centre of pressure per error beyond the first."},
              &c.pressure_gain);
  d.parameter({"goal_x_m", "m", -0.2, 0.2, 0, "Where xi comes to rest, forward of the feet's middle."}, &c.goal_x_m);
  d.parameter({"touch_N", "N", 1, 200, 15, "Force of a foot that has landed."}, &c.touch_N);
  d.parameter({"touch_s", "s", 0, 0.1, c.touch_s, "How long it must bear that."}, &c.touch_s);
  d.parameter({"trust_per_s", "1/s", 0, 1000, 15, "Rate at which xi follows what is measured, once it has stepped."},
              &c.trust_per_s);
}

void DcmStep::declare_signals(Declaration& d) {
  const StepPlan::State& s = plan_.state();
  d.signal({"phase", "", "0 stands, 1 swings, 2 bears; -1 lets go."}, &phase_number_);
  d.signal({"steps", "", "Steps since it was enabled."}, &s.steps);
  d.signal({"time_s", "s", "In the phase."}, &s.time_s);
  d.signal({"dcm_x_m", "m", "Divergent component of motion, forward of the stance foot."}, &s.dcm.x_m);
  d.signal({"dcm_y_m", "m", "Left of it."}, &s.dcm.y_m);
  d.signal({"foothold_x_m", "m", "Where the other foot goes, forward of the stance foot."}, &s.foothold.x_m);
  d.signal({"foothold_y_m", "m", "Left of it."}, &s.foothold.y_m);
  d.signal({"other_x_m", "m", "The other foot when it lifted, or landed, forward of the stance foot."}, &s.from_m[0]);
  d.signal({"other_y_m", "m", "Left of it."}, &s.from_m[1]);
  d.signal({"dcm_rate_m_s", "m/s", "Rate of the first."}, &s.dcm_rate_m_s);
  d.signal({"pressure_x_m", "m", "Centre of pressure asked for, forward of a sole's frame."}, &s.in_sole.x_m);
  d.signal({"right_share", "", "Share of the load asked of the right foot."}, &s.right_share);
  d.signal({"lean_rad", "rad", "Lean of the torso asked for."}, &lean_rad_);
  for (Leg& leg : legs_) leg.declare_signals(d);
}

void DcmStep::start(const ControlInput&) noexcept {
  plan_.reset();
  phase_ = StepPlan::Phase::stands;
  given_up_ = false;
}

void DcmStep::let_go(ActuationFrame& actuation) noexcept {
  for (const JointAxis& axis : axes_) actuation.joints[axis.joint] = {};
  for (Leg& leg : legs_) leg.effort_Nm = {};
  phase_ = StepPlan::Phase::stands;
  over_feet_.follow_heading();
}

void DcmStep::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool enabled = config_.enabled > 0.5;
  if (!enabled) {
    plan_.reset();
    given_up_ = false;
  }
  const bool stands = enabled && over_feet_.update(input) && input.status.base.tilt_rad <= config_.tilt_max_rad;
  if (enabled && !stands) given_up_ = true;
  phase_number_ = given_up_ || !enabled ? -1 : static_cast<double>(plan_.state().phase);
  if (!stands || given_up_) return let_go(actuation);
  plan_.advance(plan_config_,
                {.over = {over_feet_.over(0), over_feet_.over(1)},
                 .force_N = {input.status.feet[0].force_N, input.status.feet[1].force_N},
                 .cop_x_m = {input.status.feet[0].cop_x_m, input.status.feet[1].cop_x_m},
                 .rate_per_s = over_feet_.rate_per_s()},
                input.dt_s);
  const StepPlan::Phase phase = plan_.state().phase;
  if (phase == StepPlan::Phase::stands) return let_go(actuation);
  if (phase != phase_) enter(phase, input);
  lean_rad_ *= 1 - std::min(input.dt_s / config_.lean_s, 1.0);
  if (phase == StepPlan::Phase::swings)
    swing_torques(input);
  else
    bearing_torques(input);
  write(input, actuation);
}

// Goes on from what is: the lean, the angles, the ankles' torques.
void DcmStep::enter(StepPlan::Phase phase, const ControlInput& input) noexcept {
  if (phase_ == StepPlan::Phase::stands) {
    over_feet_.keep_heading(input);
    lean_rad_ = input.status.base.pitch_rad;
    for (std::size_t i = 0; i < 2; ++i)
      ankle_Nm_[i] = input.last.joints[legs_[i].inverse.axis(ankle_pitch).joint].effort_Nm;
  }
  for (Leg& leg : legs_) {
    for (std::size_t i = 0; i < leg_joints; ++i) {
      const JointState& joint = input.joints.joints[leg.inverse.axis(i).joint];
      leg.landed_rad[i] = joint.position_rad;
      leg.landed_rad_s[i] = config_.carry * joint.velocity_rad_s;
      leg.rate_rad_s[i] = phase == StepPlan::Phase::swings ? 0 : leg.landed_rad_s[i];
    }
    leg.target_rad = leg.landed_rad;
  }
  alone_ = 0;
  phase_ = phase;
}

void DcmStep::write(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const double smooth = config_.ankle_smooth_s > input.dt_s ? input.dt_s / config_.ankle_smooth_s : 1;
  for (std::size_t leg = 0; leg < 2; ++leg) {
    Efforts& effort_Nm = legs_[leg].effort_Nm;
    ankle_Nm_[leg] += smooth * (effort_Nm[ankle_pitch] - ankle_Nm_[leg]);
    effort_Nm[ankle_pitch] = ankle_Nm_[leg];
    for (std::size_t i = 0; i < leg_joints; ++i) {
      const JointAxis& axis = legs_[leg].inverse.axis(i);
      actuation.joints[axis.joint] = {.effort_Nm = std::clamp(effort_Nm[i], -axis.effort_max_Nm, axis.effort_max_Nm),
                                      .mode = ActuationMode::effort};
    }
  }
}

void DcmStep::pass_state(StateBytes& bytes) noexcept {
  for (Leg& leg : legs_) bytes(leg.target_rad, leg.rate_rad_s, leg.landed_rad, leg.landed_rad_s, leg.effort_Nm);
  bytes(over_feet_, plan_, phase_, given_up_, lean_rad_, ankle_Nm_, alone_, phase_number_);
}

std::unique_ptr<ControlObject> make_dcm_step(const ObjectSetup& setup) { return std::make_unique<DcmStep>(setup); }

DcmStep::DcmStep(const ObjectSetup& setup)
    : axes_(joint_axes(setup)),
      over_feet_(setup),
      legs_{Leg{{.inverse = LegInverse(setup.model, axes_, over_feet_.feet()[0])}},
            Leg{{.inverse = LegInverse(setup.model, axes_, over_feet_.feet()[1])}}},
      weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {}

Vec3 DcmStep::hip(std::size_t leg) const noexcept { return rotate(over_feet_.upright(), legs_[leg].inverse.hip_m()); }

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
  swing.aim(reach(b, plan_.other_foot(plan_config_), input), rate_max_rad_s, input.dt_s);
  swing.effort_Nm = swing.spring(c.gains, 1, input);

  const double share = swing_way(plan_.state().time_s / plan_config_.swing_s);
  LegInverse::Angles held_rad = stance.landed_rad;
  held_rad[knee] += share * (c.stance_knee_rad - held_rad[knee]);
  held_rad[hip_yaw] *= 1 - share;
  stance.aim(held_rad, rate_max_rad_s, input.dt_s);
  const Efforts held_Nm = stance.spring(c.gains, 1, input), borne_Nm = bearing(a, weight_N_, input);
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
    leg.aim(target_rad, rate_max_rad_s, input.dt_s);
    const double share = i == 1 ? s.right_share : 1 - s.right_share;
    const Efforts held_Nm = leg.spring(c.gains, c.soft_share, input), borne_Nm = bearing(i, share * weight_N_, input);
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
