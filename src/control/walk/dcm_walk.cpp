#include "dcm_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

constexpr double walk_rate_max_rad_s = 7;
constexpr double kick_rate_max_rad_s = 15;
constexpr double rest_gain = 0.4;    // shift of the load per error of xi while it rests: both knees are to push it up
constexpr double learnt_most = 0.5;  // of a joint's torque
constexpr double within = 0.8;       // of the sole: a pressure farther out is at its edge
// The robot that the defaults were found on, TULip, and how much of its sole it uses.
constexpr double found_leg_m = 0.55, found_mass_kg = 14, found_hips_m = 0.17;
constexpr double heel_share = 0.75, toe_share = 1 / 1.4, half_width_share = 0.6;
enum Channel : std::uint32_t {
  forward_channel,
  left_channel,
  turn_channel,
  go_channel,
  x_channel,
  y_channel,
  heading_channel,
  kick_x_channel,
  kick_y_channel,
  kick_rad_channel,
  kick_channel,
  channels
};

FootShape smaller(const FootShape& a, const FootShape& b) noexcept {
  return {std::min(a.front_m, b.front_m), std::min(a.back_m, b.back_m), std::min(a.side_m, b.side_m),
          std::max(a.below_m, b.below_m)};
}

}  // namespace

DcmWalk::Leg DcmWalk::leg(const ObjectSetup& setup, std::size_t foot) const {
  Leg made{{.inverse = LegInverse(setup.model, axes_, foot)}, LegLoad(setup.model, foot), {}, {}};
  for (std::size_t j = 0; j < leg_joints; ++j) {
    const auto bearings = made.load.bearings();
    const auto found = std::ranges::find(bearings, made.inverse.axis(j).joint, &LegLoad::Bearing::joint);
    made.bearing[j] = static_cast<std::size_t>(found - bearings.begin());
  }
  return made;
}

DcmWalk::DcmWalk(const ObjectSetup& setup)
    : axes_(joint_axes(setup)),
      over_feet_(setup),
      legs_{leg(setup, over_feet_.feet()[0]), leg(setup, over_feet_.feet()[1])},
      weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()),
      foot_(smaller(shape_of(setup.model, over_feet_.feet()[0]), shape_of(setup.model, over_feet_.feet()[1]))),
      // As float, because a sum of masses differs in the last places from what it shall be.
      similarity_{static_cast<float>(legs_[0].inverse.length_m() / found_leg_m),
                  static_cast<float>(setup.model.mass_kg() / found_mass_kg)} {
  const double hips_m = std::abs(legs_[0].inverse.hip_m()[1] - legs_[1].inverse.hip_m()[1]);
  config_.sole_m = foot_.below_m;
  plan_config_.width_m *= static_cast<float>(hips_m / found_hips_m);
  plan_config_.sole = {.heel_m = heel_share * foot_.back_m,
                       .toe_m = toe_share * foot_.front_m,
                       .half_width_m = half_width_share * foot_.side_m};
  plan_config_.kick.tip_m = foot_.front_m;
}

void DcmWalk::declare(Declaration& declaration) {
  const FittedDeclaration d(declaration, similarity_);
  Config& c = config_;
  d.tunable("tilt_max_rad", "rad", 0, 1.5, c.tilt_max_rad, "Tilt of the trunk beyond which it gives up.");
  d.tunable("height_m", "m", 0.1, 2, c.height_m, "Of the centre of mass over the foot that stands.");
  d.tunable("height_N_per_m", "N/m", 0, 200000, c.height_N_per_m, "Keeps that height.");
  d.tunable("height_Ns_per_m", "N s/m", 0, 20000, c.height_Ns_per_m, "Damps it.");
  d.tunable("lift_max", "", 0, 1, c.lift_max, "Most of both, per weight.");
  d.tunable("lean_rad", "rad", -0.5, 0.5, c.lean_rad, "Of the torso, forward.");
  d.tunable("torso_Nm_per_rad", "Nm/rad", 0, 20000, c.torso_Nm_per_rad, "Holds the torso, in pitch.");
  d.tunable("torso_Nms_per_rad", "Nm s/rad", 0, 2000, c.torso_Nms_per_rad, "Damps it.");
  d.tunable("level_Nm_per_rad", "Nm/rad", 0, 20000, c.level_Nm_per_rad, "Holds the torso, in roll.");
  d.tunable("level_Nms_per_rad", "Nm s/rad", 0, 2000, c.level_Nms_per_rad, "Damps it.");
  d.tunable("counter_share", "", 0, 1, c.counter_share, "Of the swing hip's torque that the stance hip takes.");
  d.tunable("grip", "", 0, 2, c.grip, "Largest force along the ground, per load.");
  d.tunable("yaw_grip_m", "m", 0, 1, c.yaw_grip_m,
            "Largest torque of the yaw of a leg that bears, per load of its foot; 0: as much as its motor has.");
  d.own("sole_m", "m", 0, 0.5, c.sole_m, "How far the sole is below a foot's frame.");
  d.tunable("slope_s", "s", 0.01, 100, c.slope_s, "In which the slope of the ground is learnt.");
  d.tunable("slope_max", "", 0, 1, c.slope_max, "The largest slope that it believes in.");
  d.tunable("shift_s", "s", 0.001, 1, c.shift_s, "In which a leg that landed takes the load.");
  d.tunable("ankle_smooth_s", "s", 0, 0.1, c.ankle_smooth_s, "Low pass of the ankles' torques.");
  d.tunable("by_now", "", 0, 1, c.by_now, "How far the swinging leg's length and sole follow where it is by now.");
  d.tunable("ankle_by_load", "", 0, 1, c.ankle_by_load,
            "How far an ankle's torque follows the load that its foot bears.");
  d.tunable("fade_s", "s", 0, 0.1, c.fade_s, "In which the torques of a leg's part pass into the next one's.");
  d.tunable("stand_s", "s", 0, 10, c.stand_s, "After the last step, before it counts as standing.");
  d.tunable("learn_share", "", 0, 1, c.learn_share, "Of a swing's torques that the leg's next one begins with.");
  config_.gains.declare(d);
  declare_plan(d);
  declare_signals(declaration);
}

void DcmWalk::declare_plan(const FittedDeclaration& d) {
  WalkPlan::Config& c = plan_config_;
  d.tunable("step_s", "s", 0.1, 2, c.step_s, "Time of a step.");
  d.tunable("step_min_s", "s", 0.05, 2, c.step_min_s, "Shortest step.");
  d.tunable("step_max_s", "s", 0.1, 2, c.step_max_s, "Longest step.");
  d.own("width_m", "m", 0, 1, c.width_m, "Between the feet, sideways.");
  d.tunable("apart_min_m", "m", 0, 1, c.apart_min_m, "Least distance of the feet, sideways.");
  d.tunable("apart_max_m", "m", 0, 1, c.apart_max_m, "Largest distance of the feet, sideways.");
  d.tunable("reach_m", "m", 0, 1, c.reach_m, "Longest step.");
  d.tunable("lift_m", "m", 0, 0.3, c.lift_m, "Height of a swing.");
  d.tunable("place_share", "", 0.5, 1, c.place_share, "Of a swing, after which the foot is over its foothold.");
  d.tunable("sink_m_s", "m/s", 0, 2, c.sink_m_s, "How a late foot looks for the ground.");
  d.tunable("place_weight", "", 0, 100, c.place_weight, "Of the meant step, beside the offset's 1.");
  d.tunable("time_weight", "m2/s2", 0, 100, c.time_weight, "Of the meant time, beside the offset's 1.");
  d.tunable("side_rate_share", "", 0.3, 1.5, c.side_rate_share, "Rate of falling sideways, of that along.");
  d.tunable("trust_per_s", "1/s", 0, 1000, c.trust_per_s, "Rate at which xi follows what is measured.");
  d.tunable("both_trust_per_s", "1/s", 0, 1000, c.both_trust_per_s, "The same while both feet bear.");
  d.tunable("by_load", "", 0, 1, c.by_load, "How far the feet's loads decide which one's measured xi counts.");
  d.tunable("edge_share", "", 0, 2, c.edge_share, "Of the measured pressure across, for where xi will be.");
  d.tunable("ankle_gain", "", 0, 20, c.ankle_gain, "Shift of the pressure per error of xi.");
  d.tunable("shift_x_m", "m", -0.1, 0.1, c.shift_x_m, "Where the pressure is meant to be, before a foot's frame.");
  d.tunable("trim_per_s", "1/s", 0, 10, c.trim_per_s, "How fast the meant speed is corrected.");
  d.tunable("trim_max_m_s", "m/s", 0, 1, c.trim_max_m_s, "Largest such correction.");
  d.tunable("touch_N", "N", 1, 2000, c.touch_N, "Force of a foot that has landed.");
  d.tunable("touch_s", "s", 0, 0.1, c.touch_s, "How long it must bear that.");
  d.tunable("early_share", "", 0, 1, c.early_share, "Of a swing, before which no landing counts.");
  d.tunable("sway_gain", "", 0, 20, c.sway_gain, "Shift of the load per error of xi, before the first step.");
  d.tunable("sway_s", "s", 0, 5, c.sway_s, "Longest time from standing to the first step.");
  d.tunable("speed_max_m_s2", "m/s2", 0.01, 10, c.speed_max_m_s2, "How fast the meant velocity changes.");
  d.tunable("brake_m_s2", "m/s2", 0.01, 10, c.brake_m_s2, "How fast it does once the robot shall stand.");
  d.tunable("sunk_m", "m", 0.001, 1, c.sunk_m, "How far it may sink before it rests on both feet.");
  d.tunable("rest_s", "s", 0, 10, c.rest_s, "Longest rest.");
  d.own("heel_m", "m", 0.001, 0.5, c.sole.heel_m, "Of the sole that may bear, behind the foot's frame.");
  d.own("toe_m", "m", 0.001, 0.5, c.sole.toe_m, "Before it.");
  declare_kick(d);
}

void DcmWalk::declare_kick(const FittedDeclaration& d) {
  KickSwing::Config& c = plan_config_.kick;
  d.own("kick.ball_radius_m", "m", 0.02, 0.3, c.ball_radius_m, "Of the ball that it kicks.");
  d.own("kick.tip_m", "m", 0, 0.5, c.tip_m, "How far the tip of a foot is before its frame.");
  d.tunable("kick.strike_s", "s", 0.05, 1, c.strike_s, "From lift-off to the strike.");
  d.tunable("kick.after_s", "s", 0.02, 1, c.after_s, "Least time from there to the landing.");
  d.tunable("kick.step_s", "s", 0.1, 2, c.step_s, "Time of the step that kicks.");
  d.tunable("kick.swing_s_per_m_s", "s2/m", 0, 1, c.swing_s_per_m_s, "Least time to the strike, by the foot's speed.");
  d.tunable("kick.follow_m", "m", 0, 0.5, c.follow_m, "How far the foot goes on beyond the strike, forward.");
  d.tunable("kick.lead_s", "s", 0, 0.1, c.lead_s, "How far the reference is ahead, for the lag of the leg.");
  d.tunable("kick.height_m", "m", 0, 0.2, c.height_m, "Of the sole at the strike.");
  d.tunable("kick.near_m", "m", -0.5, 0.5, c.near_m, "Where the foot may be at the strike, at least.");
  d.tunable("kick.far_m", "m", -0.5, 0.5, c.far_m, "Likewise, at most.");
  d.tunable("kick.inside_m", "m", 0, 1, c.inside_m, "Likewise to the side of the other foot, at least.");
  d.tunable("kick.outside_m", "m", 0, 1, c.outside_m, "Likewise, at most.");
}

void DcmWalk::declare_signals(Declaration& d) {
  const auto setpoint = [&](const char* name, const char* unit, double min, double max, const char* doc,
                            std::uint32_t channel) {
    const double safe = channel == go_channel || channel == kick_channel ? 0 : std::numeric_limits<double>::quiet_NaN();
    d.setpoint({.name = name,
                .unit = unit,
                .min = min,
                .max = max,
                .doc = doc,
                .channel = channel,
                .joint = no_joint,
                .safe = safe});
  };
  const double faster = std::round(100 * similarity_.of("m/s")) / 100;
  setpoint("forward_m_s", "m/s", -0.25 * faster, 0.65 * faster, "Velocity forward.", forward_channel);
  setpoint("left_m_s", "m/s", -0.2 * faster, 0.2 * faster, "Velocity to the left.", left_channel);
  setpoint("turn_rad_s", "rad/s", -1, 1, "Turning to the left.", turn_channel);
  setpoint("go", "", 0, 1, "1: walks; 0: comes to stand. Reads 1 until it stands.", go_channel);
  setpoint("x_m", "m", -1e4, 1e4, "Where the base is by its steps; setting it sets it there.", x_channel);
  setpoint("y_m", "m", -1e4, 1e4, "Likewise, to the left.", y_channel);
  setpoint("heading_rad", "rad", -std::numbers::pi, std::numbers::pi, "Likewise, its heading.", heading_channel);
  setpoint("kick_x_m", "m", -1e4, 1e4, "Where the ball to be kicked is.", kick_x_channel);
  setpoint("kick_y_m", "m", -1e4, 1e4, "Likewise, to the left.", kick_y_channel);
  setpoint("kick_rad", "rad", -std::numbers::pi, std::numbers::pi, "Where the ball shall go.", kick_rad_channel);
  setpoint("kick_m_s", "m/s", 0, 3 * faster, "Speed of the foot; 0: no kick. Reads 0 when the ball was kicked.",
           kick_channel);
  const WalkPlan::State& s = plan_.state();
  d.signal({"phase", "", "0 stands, 1 sways, 2 steps, 3 bears, 4 rests; -1 has given up."}, &phase_number_);
  d.signal({"stance", "", "The foot that stands: 0 left, 1 right."}, &stance_number_);
  d.signal({"steps", "", "Steps since it began."}, &s.steps);
  d.signal({"time_s", "s", "In the step."}, &s.time_s);
  d.signal({"step_s", "s", "When the foot is meant to land."}, &s.step_s);
  d.signal({"dcm_x_m", "m", "Divergent component of motion, forward of the stance foot."}, &s.dcm.x_m);
  d.signal({"dcm_y_m", "m", "Left of it."}, &s.dcm.y_m);
  d.signal({"offset_x_m", "m", "Meant distance from the foothold to xi at the landing, forward."}, &s.meant.offset.x_m);
  d.signal({"offset_y_m", "m", "To the left."}, &s.meant.offset.y_m);
  d.signal({"foothold_x_m", "m", "Where the other foot goes, forward of the stance foot."}, &s.feet.foothold.x_m);
  d.signal({"foothold_y_m", "m", "Left of it."}, &s.feet.foothold.y_m);
  d.signal({"at_x_m", "m", "Where the other foot shall be now, forward of the stance foot."}, &s.feet.at_m[0]);
  d.signal({"at_y_m", "m", "Left of it."}, &s.feet.at_m[1]);
  d.signal({"at_z_m", "m", "Above it."}, &s.feet.at_m[2]);
  d.signal({"pressure_x_m", "m", "Centre of pressure asked for, forward of the stance foot's frame."}, &s.in_sole_x_m);
  d.signal({"trim_x_m_s", "m/s", "Correction of the speed forward."}, &s.meant.trim_m_s.x_m);
  d.signal({"trim_y_m_s", "m/s", "Likewise to the left."}, &s.meant.trim_m_s.y_m);
  d.signal({"kicks", "", "Kicks since it set out."}, &s.kicks);
  d.signal({"x_m", "m", "Where the base is by its steps."}, &odometry_.x_m);
  d.signal({"y_m", "m", "Where the base is by its steps, to the left."}, &odometry_.y_m);
  d.signal({"heading_rad", "rad", "Its heading."}, &odometry_.heading_rad);
  d.signal({"slope_x", "", "Slope of the ground as it is felt, forward."}, &slope_.x_m);
  d.signal({"slope_y", "", "To the left."}, &slope_.y_m);
  d.signal({"height_m", "m", "Of the centre of mass over the stance foot's frame."}, &com_height_m_);
  for (Leg& leg : legs_) leg.declare_signals(d);
}

void DcmWalk::start(const ControlInput&) noexcept {
  plan_.reset();
  wanted_ = {};
  given_up_ = false;
  over_feet_.follow_heading();
}

bool DcmWalk::stands() const noexcept {
  const WalkPlan::State& s = plan_.state();
  return s.phase == WalkPlan::Phase::stands || (s.phase == WalkPlan::Phase::bears && s.time_s > config_.stand_s);
}

bool DcmWalk::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  const std::array<double, channels> values{wanted_.velocity.forward_m_s,
                                            wanted_.velocity.left_m_s,
                                            wanted_.velocity.turn_rad_s,
                                            stands() ? 0.0 : 1.0,
                                            odometry_.x_m,
                                            odometry_.y_m,
                                            odometry_.heading_rad,
                                            ball_.ball.x_m,
                                            ball_.ball.y_m,
                                            ball_.rad,
                                            ball_.m_s};
  state = {.value = values[channel]};
  return true;
}

void DcmWalk::follow(std::uint32_t channel, const SetpointState& state) noexcept {
  Odometry& o = odometry_;
  if (channel == forward_channel) wanted_.velocity.forward_m_s = state.value;
  if (channel == left_channel) wanted_.velocity.left_m_s = state.value;
  if (channel == turn_channel) wanted_.velocity.turn_rad_s = state.value;
  if (channel == go_channel) wanted_.go = state.value >= 0.5;
  if (channel == kick_x_channel) ball_.ball.x_m = state.value;
  if (channel == kick_y_channel) ball_.ball.y_m = state.value;
  if (channel == kick_rad_channel) ball_.rad = state.value;
  if (channel == kick_channel) ball_.m_s = state.value;
  if (channel == x_channel) o.x_m = state.value;
  if (channel == y_channel) o.y_m = state.value;
  if (channel == heading_channel) o.heading_rad = state.value;
}

// Goes on by what the robot's odometry went on since the last tick, from the heading that it has here.
void DcmWalk::reckon(const OdometryStatus& now) noexcept {
  Odometry& o = odometry_;
  if (now.resets == o.seen_resets) {
    const double apart_rad = o.heading_rad - o.seen_heading_rad, c = std::cos(apart_rad), n = std::sin(apart_rad);
    const double x_m = now.x_m - o.seen_x_m, y_m = now.y_m - o.seen_y_m;
    o.x_m += c * x_m - n * y_m;
    o.y_m += n * x_m + c * y_m;
    o.heading_rad = std::remainder(o.heading_rad + now.heading_rad - o.seen_heading_rad, 2 * std::numbers::pi);
  }
  o.seen_x_m = now.x_m;
  o.seen_y_m = now.y_m;
  o.seen_heading_rad = now.heading_rad;
  o.seen_resets = now.resets;
}

// The ball as the plan has it: from the foot that stands, in the heading frame.
void DcmWalk::see_ball() noexcept {
  wanted_.kick = {};
  if (!(ball_.m_s > 0)) return;
  const Odometry& o = odometry_;
  const double frame_rad = o.heading_rad - over_feet_.yaw_rad();
  const double c = std::cos(frame_rad), n = std::sin(frame_rad);
  const double x_m = ball_.ball.x_m - o.x_m, y_m = ball_.ball.y_m - o.y_m;
  const Vec3& foot_m = over_feet_.over(plan_.state().stance).foot_m;
  wanted_.kick = {{c * x_m + n * y_m - foot_m[0], c * y_m - n * x_m - foot_m[1]},
                  std::remainder(ball_.rad - frame_rad, 2 * std::numbers::pi),
                  ball_.m_s};
}

void DcmWalk::let_go(ActuationFrame& actuation) noexcept {
  for (const JointAxis& axis : axes_) actuation.joints[axis.joint] = {};
  for (Leg& leg : legs_) leg.effort_Nm = {};
  plan_.reset();
  over_feet_.follow_heading();
}

WalkPlan::Sight DcmWalk::sight(const ControlInput& input) const noexcept {
  const auto& feet = input.status.feet;
  return {.over = {over_feet_.over(0), over_feet_.over(1)},
          .force_N = {feet[0].force_N, feet[1].force_N},
          .cop_x_m = {feet[0].cop_x_m, feet[1].cop_x_m},
          .cop_y_m = {feet[0].cop_y_m, feet[1].cop_y_m},
          .rate_per_s = over_feet_.rate_per_s(),
          .slope = slope_,
          .sunk_m = config_.height_m - over_feet_.over(plan_.state().stance).com_m[2]};
}

void DcmWalk::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  reckon(input.status.odometry);
  if (!wanted_.go) given_up_ = false;
  const bool idle = plan_.state().phase == WalkPlan::Phase::stands;
  phase_number_ = given_up_ ? -1 : static_cast<double>(plan_.state().phase);
  if (given_up_ || (idle && !wanted_.go)) return let_go(actuation);
  if (!over_feet_.update(input) || !(input.status.base.tilt_rad <= config_.tilt_max_rad)) {
    given_up_ = wanted_.go;
    return let_go(actuation);
  }
  if (idle) begin(input);
  if (wanted_.go && stands()) {
    plan_.begin(plan_config_, sight(input));
    landed(input);
  }
  feel_ground(input);
  see_ball();
  const std::uint32_t kicks = plan_.state().kicks;
  if (plan_.advance(plan_config_, wanted_, sight(input), input.dt_s)) landed(input);
  const WalkPlan::State& s = plan_.state();
  if (s.kicks != kicks) ball_.m_s = 0;
  phase_number_ = static_cast<double>(s.phase);
  stance_number_ = static_cast<double>(s.stance);
  if (s.phase != WalkPlan::Phase::steps) {
    both_torques(input);
  } else {
    swing_torques(input);
  }
  write(input, actuation);
}

// A foot that bears the robot lies flat, but not while it lands or leaves, nor while the pressure is at its edge.
void DcmWalk::feel_ground(const ControlInput& input) noexcept {
  const WalkPlan::State& s = plan_.state();
  const double share = s.time_s / std::max(s.step_s, input.dt_s), rate = std::min(input.dt_s / config_.slope_s, 1.0);
  const FootStatus& foot = input.status.feet[s.stance];
  if (s.phase == WalkPlan::Phase::steps && !(share > 0.3 && share < 0.8)) return;
  if (!(std::abs(foot.cop_y_m) < within * foot_.side_m && foot.cop_x_m < within * foot_.front_m &&
        foot.cop_x_m > -within * foot_.back_m))
    return;
  const DcmMeasure::OverFoot& over = over_feet_.over(s.stance);
  const double most = config_.slope_max;
  slope_.x_m += rate * (std::clamp(over.toe_up_m, -most, most) - slope_.x_m);
  slope_.y_m += rate * (std::clamp(over.left_up_m, -most, most) - slope_.y_m);
}

void DcmWalk::begin(const ControlInput& input) noexcept {
  over_feet_.keep_heading(input);
  (void)over_feet_.update(input);
  plan_.begin(plan_config_, sight(input));
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t j = 0; j < leg_joints; ++j)
      legs_[i].effort_Nm[j] = input.last.joints[legs_[i].inverse.axis(j).joint].effort_Nm;
    ankle_Nm_[i] = legs_[i].effort_Nm[ankle_pitch];
    legs_[i].learnt = {};
  }
  landed(input);
}

// The load goes to the leg that landed. Targets go on from the measured angles.
void DcmWalk::landed(const ControlInput& input) noexcept {
  const double turn_rad = plan_.state().meant.turn_rad;
  if (turn_rad != 0) {
    over_feet_.turn_heading(turn_rad);
    plan_.turned(turn_rad);
    (void)over_feet_.update(input);
  }
  changes_ = true;
  Leg& lands = legs_[plan_.state().stance];
  Efforts most_Nm{};
  for (std::size_t j = 0; j < leg_joints; ++j) most_Nm[j] = learnt_most * lands.inverse.axis(j).effort_max_Nm;
  lands.learnt.learn(config_.learn_share, most_Nm);
  for (Leg& leg : legs_) {
    leg.jump_Nm = leg.effort_Nm;
    for (std::size_t i = 0; i < leg_joints; ++i) {
      const JointState& joint = input.joints.joints[leg.inverse.axis(i).joint];
      leg.target_rad[i] = joint.position_rad;
      leg.rate_rad_s[i] = joint.velocity_rad_s;
    }
  }
}

// From the pressure in a foot to the centre of mass.
GroundPoint DcmWalk::lever(std::size_t i, double in_sole_x_m) const noexcept {
  const Vec3& com_m = over_feet_.over(i).com_m;
  return {com_m[0] - in_sole_x_m, com_m[1]};
}

// The torques of a leg that bears this share of the robot, by a force that points along the lever at the height of the
// centre of mass. With no share, those that bear the leg alone.
DcmWalk::Efforts DcmWalk::bearing(std::size_t i, double share, double in_sole_x_m, const GroundPoint& lever_m,
                                  const ControlInput& input) noexcept {
  Leg& leg = legs_[i];
  const DcmMeasure::OverFoot& over = over_feet_.over(i);
  const double lift_N =
      config_.height_N_per_m * (config_.height_m - over.com_m[2]) - config_.height_Ns_per_m * over.velocity_m_s[2];
  const double most_N = config_.lift_max * weight_N_;
  const double height_m = std::max(over.com_m[2], lowest_com_m) + config_.sole_m;
  const double force_N = share * (weight_N_ + std::clamp(lift_N, -most_N, most_N));
  if (i == plan_.state().stance) com_height_m_ = over.com_m[2];
  const double grip_N = config_.grip * force_N;
  const double x_N = (force_N * lever_m.x_m - share * turn_Nm_[1]) / height_m;
  const double y_N = (force_N * lever_m.y_m + share * turn_Nm_[0]) / height_m;
  const Vec3 force{std::clamp(x_N, -grip_N, grip_N), std::clamp(y_N, -grip_N, grip_N), force_N};
  leg.load.update(over_feet_.kinematics(), force,
                  {over.foot_m[0] + in_sole_x_m, over.foot_m[1], over.foot_m[2] - config_.sole_m});
  Efforts effort_Nm{};
  for (std::size_t j = 0; j < leg_joints; ++j) effort_Nm[j] = leg.load.bearings()[leg.bearing[j]].effort_Nm;
  const double ground_N = std::max(input.status.feet[i].force_N, 0.0);
  // A foot that bears less than it was asked to would turn about its toes by the torque that was meant for all of it.
  if (force_N > ground_N) effort_Nm[ankle_pitch] *= 1 - config_.ankle_by_load * (1 - ground_N / force_N);
  effort_Nm[ankle_pitch] = std::clamp(effort_Nm[ankle_pitch], -ground_N * foot_.back_m, ground_N * foot_.front_m);
  return effort_Nm;
}

// More would spin the foot on the ground: its toes turn in, and the other foot comes down on it.
double DcmWalk::gripped_Nm(std::size_t i, double yaw_Nm, const ControlInput& input) const noexcept {
  if (config_.yaw_grip_m <= 0) return yaw_Nm;
  const double most_Nm = config_.yaw_grip_m * std::max(input.status.feet[i].force_N, 0.0);
  return std::clamp(yaw_Nm, -most_Nm, most_Nm);
}

// The moment that rights the torso and takes the swing leg's reaction.
void DcmWalk::turn(const Efforts& swing_Nm, const ControlInput& input) noexcept {
  const Config& c = config_;
  const BaseStatus& base = input.status.base;
  const Vec3& w = base.angular_velocity_rad_s;
  turn_Nm_ = {c.counter_share * swing_Nm[hip_roll] - c.level_Nm_per_rad * base.roll_rad - c.level_Nms_per_rad * w[0],
              c.counter_share * swing_Nm[hip_pitch] - c.torso_Nm_per_rad * (base.pitch_rad - c.lean_rad) -
                  c.torso_Nms_per_rad * w[1]};
}

void DcmWalk::swing_torques(const ControlInput& input) noexcept {
  const Config& c = config_;
  const WalkPlan::State& s = plan_.state();
  const std::size_t a = s.stance, b = 1 - a;
  Leg &stance = legs_[a], &swing = legs_[b];
  const double loaded = std::min(s.time_s / c.shift_s, 1.0);
  const DcmMeasure::OverFoot& over = over_feet_.over(a);

  const Vec3 swing_hip_m = rotate(over_feet_.upright(), swing.inverse.hip_m());
  const double toe_up_m = over.toe_up_m - slope_.x_m;  // on its toes, or heel
  const double risen_m =
      std::max(-toe_up_m * foot_.front_m, toe_up_m * foot_.back_m) -
      foot_.side_m * std::abs(over_feet_.over(b).left_up_m - slope_.y_m) -  // tilted, it reaches deeper
      slope_.x_m * s.feet.at_m[0] - slope_.y_m * s.feet.at_m[1];
  const Vec3 way_m{over.foot_m[0] + s.feet.at_m[0] - swing_hip_m[0], over.foot_m[1] + s.feet.at_m[1] - swing_hip_m[1],
                   over.foot_m[2] + s.feet.at_m[2] - swing_hip_m[2] - risen_m};
  const double yaw_rad = plan_.other_yaw_rad(plan_config_) - over_feet_.yaw_rad();
  const BaseStatus& base = input.status.base;
  // Not longer than is right where the foot is by now: on a long step it lags, and would touch the ground on its way.
  // The sole is level with the ground by what hip and knee are, not by what they shall be. A kick is aimed without
  // both.
  const double by_now = s.kick.kicks() ? 0 : c.by_now;
  const Vec3 is_m = difference(over_feet_.over(b).foot_m, swing_hip_m);
  const double leg_m = swing.inverse.longest_m();
  const double longest_m = leg_m + by_now * (length({is_m[0], is_m[1], way_m[2]}) - leg_m);
  LegInverse::Angles swing_rad = swing.inverse.angles(rotate_inverse(over_feet_.upright(), way_m), yaw_rad, longest_m);
  const auto& joints = input.joints.joints;
  const double lag_rad = joints[swing.inverse.axis(hip_pitch).joint].position_rad - swing_rad[hip_pitch] +
                         joints[swing.inverse.axis(knee).joint].position_rad - swing_rad[knee];
  swing_rad[ankle_pitch] -= by_now * lag_rad + base.pitch_rad + slope_.x_m;
  swing.aim(swing_rad, s.kick.kicks() ? kick_rate_max_rad_s : walk_rate_max_rad_s, input.dt_s);
  Efforts swing_Nm = swing.spring(c.gains, input);
  if (!s.kick.kicks()) {  // a kick is like no other swing
    const Efforts ahead_Nm = swing.learnt.at(s.time_s);
    swing.learnt.see(s.time_s, swing_Nm);
    for (std::size_t j = 0; j < leg_joints; ++j) swing_Nm[j] += ahead_Nm[j];
  }
  turn(swing_Nm, input);
  const Efforts left_Nm = bearing(b, 1 - loaded, 0, lever(b, 0), input);

  LegInverse::Angles stance_rad = stance.target_rad;
  stance_rad[hip_yaw] = over.yaw_rad;
  stance.aim(stance_rad, walk_rate_max_rad_s, input.dt_s);
  const Efforts stance_Nm = stance.spring(c.gains, input),
                borne_Nm = bearing(a, loaded, s.in_sole_x_m, lever(a, s.in_sole_x_m), input);

  for (std::size_t j = 0; j < leg_joints; ++j) {
    swing.effort_Nm[j] = loaded * swing_Nm[j] + left_Nm[j];
    stance.effort_Nm[j] = borne_Nm[j];
  }
  stance.effort_Nm[hip_yaw] = gripped_Nm(a, stance_Nm[hip_yaw], input);
}

void DcmWalk::both_torques(const ControlInput& input) noexcept {
  const WalkPlan::State& s = plan_.state();
  turn({}, input);
  const std::size_t a = s.stance;
  const Vec3 &at_m = over_feet_.over(a).foot_m, &other_m = over_feet_.over(1 - a).foot_m;
  std::array<GroundPoint, 2> feet;
  feet[1 - a] = {other_m[0] - at_m[0], other_m[1] - at_m[1]};
  const GroundPoint goal = plan_.goal(plan_config_, sight(input));
  const double gain = s.phase == WalkPlan::Phase::sways   ? plan_config_.sway_gain
                      : s.phase == WalkPlan::Phase::rests ? rest_gain
                                                          : 1;
  const GroundPoint pressure{2 * s.dcm.x_m - goal.x_m, (1 + gain) * s.dcm.y_m - gain * goal.y_m};
  const LoadSplit split = split_load(plan_config_.sole, feet[0], feet[1], pressure);
  const Vec3& com_m = over_feet_.over(a).com_m;
  const GroundPoint lever_m{com_m[0] - split.at.x_m, com_m[1] - split.at.y_m};
  for (std::size_t i = 0; i < 2; ++i) {
    Leg& leg = legs_[i];
    LegInverse::Angles target_rad = leg.target_rad;
    target_rad[hip_yaw] = over_feet_.over(i).yaw_rad;
    leg.aim(target_rad, walk_rate_max_rad_s, input.dt_s);
    const double share = i == 1 ? split.right_share : 1 - split.right_share;
    const Efforts held_Nm = leg.spring(config_.gains, input),
                  borne_Nm = bearing(i, share, split.in_sole.x_m, lever_m, input);
    leg.effort_Nm = borne_Nm;
    leg.effort_Nm[hip_yaw] = gripped_Nm(i, held_Nm[hip_yaw], input);
  }
}

void DcmWalk::write(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const double smooth = config_.ankle_smooth_s > input.dt_s ? input.dt_s / config_.ankle_smooth_s : 1;
  const double left = std::max(1 - plan_.state().time_s / std::max(config_.fade_s, input.dt_s), 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    Efforts &effort_Nm = legs_[i].effort_Nm, &jump_Nm = legs_[i].jump_Nm;
    ankle_Nm_[i] += smooth * (effort_Nm[ankle_pitch] - ankle_Nm_[i]);
    effort_Nm[ankle_pitch] = ankle_Nm_[i];
    for (std::size_t j = 0; j < leg_joints; ++j) {
      const JointAxis& axis = legs_[i].inverse.axis(j);
      if (changes_) jump_Nm[j] -= effort_Nm[j];
      effort_Nm[j] += left * jump_Nm[j];
      effort_Nm[j] = std::clamp(effort_Nm[j], -axis.effort_max_Nm, axis.effort_max_Nm);
      actuation.joints[axis.joint] = {.effort_Nm = effort_Nm[j], .mode = ActuationMode::effort};
    }
  }
  changes_ = false;
}

void DcmWalk::pass_state(StateBytes& bytes) noexcept {
  for (Leg& leg : legs_) bytes(leg.target_rad, leg.rate_rad_s, leg.effort_Nm, leg.learnt, leg.jump_Nm);
  bytes(over_feet_, plan_, wanted_, ball_, odometry_, slope_, given_up_, turn_Nm_, ankle_Nm_, phase_number_,
        stance_number_, com_height_m_);
}

std::unique_ptr<ControlObject> make_dcm_walk(const ObjectSetup& setup) { return std::make_unique<DcmWalk>(setup); }

}  // namespace kadans
