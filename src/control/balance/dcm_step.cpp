#include "dcm_step.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace kadans {
namespace {

constexpr std::array<const char*, leg_joints> parts{"hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch"};
constexpr std::array<double, leg_joints> kp_first{150, 300, 300, 300, 180}, kd_first{2, 4, 4, 4, 3};

}  // namespace

void DcmStep::declare(Declaration& d) {
  Config& c = config_;
  d.parameter({"enabled", "", 0, 1, 0, "Whether it steps; 0 lets go."}, &c.enabled);
  d.parameter({"tilt_max_rad", "rad", 0, 1.5, 0.7, "Lean beyond which it gives up."}, &c.tilt_max_rad);
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
  declare_gains(d);
  declare_plan(d);
  declare_signals(d);
}

void DcmStep::declare_gains(Declaration& d) {
  Config& c = config_;
  for (std::size_t i = 0; i < leg_joints; ++i) {
    const std::string name = parts[i];
    d.parameter({name + ".kp_Nm_per_rad", "Nm/rad", 0, 2000, kp_first[i], "Torque per position error."},
                &c.kp_Nm_per_rad[i]);
    d.parameter({name + ".kd_Nms_per_rad", "Nm s/rad", 0, 200, kd_first[i], "Torque per velocity error."},
                &c.kd_Nms_per_rad[i]);
  }
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
  for (Leg& leg : legs_) {
    for (std::size_t i = 0; i < leg_joints; ++i) {
      d.signal({leg.inverse.axis(i).name + ".target_rad", "rad", "Where it shall be."}, &leg.target_rad[i]);
      d.signal({leg.inverse.axis(i).name + ".effort_Nm", "Nm", "Torque asked for."}, &leg.effort_Nm[i]);
    }
  }
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

std::unique_ptr<ControlObject> make_dcm_step(const ObjectSetup& setup) { return std::make_unique<DcmStep>(setup); }

}  // namespace kadans
