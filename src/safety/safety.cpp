#include "safety.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace kadans {
namespace {

constexpr double dt_max_s = 1;  // a step in time that is longer, or none, is not believed

void require(bool sane, const std::string& what) {
  if (!sane) throw std::invalid_argument("safety: " + what);
}

void check_limits(const JointLimits& l, const Joint& joint) {
  const bool sane = l.lower_rad <= l.upper_rad && l.velocity_max_rad_s >= 0 && l.effort_max_Nm >= 0 &&
                    l.effort_rate_max_Nm_s >= 0 && l.power_max_W >= 0 && l.continuous_Nm >= 0 &&
                    l.thermal_time_constant_s > 0;
  require(sane, "the limits of joint " + joint.name + " make no sense");
}

void check_settings(const SafetySettings& s) {
  require(s.position_margin_rad >= 0 && s.velocity_margin >= 1, "margins must be at least 0 rad and 1 times the speed");
  require(s.damping_Nms_per_rad >= 0 && s.recover_s > 0, "damping must be at least 0, recover_s above 0");
  require(s.soft_stop.zone_rad >= 0 && s.soft_stop.stiffness_Nm_per_rad >= 0, "a soft stop must not be negative");
  require(s.thermal.ambient_C < s.thermal.warm_C && s.thermal.warm_C <= s.thermal.hot_C,
          "thermal: ambient_C < warm_C <= hot_C must hold");
  require(s.drives.enable_s >= 0 && s.drives.hot_C > 0 && s.drives.sample_age_max_s > 0,
          "drives: enable_s must be at least 0, hot_C and sample_age_max_s above 0");
  require(s.supply.highest_V == 0 || s.supply.lowest_V < s.supply.highest_V, "supply: lowest_V < highest_V must hold");
  require(s.fall.soft_share >= 0 && s.fall.soft_share <= 1, "fall.soft_share must be 0..1");
}

// "position, the coupled joint velocity"
FaultWords words_of_modes(ActuationMode own, ActuationMode other) noexcept {
  FaultWords words = fault_words(name(own));
  char* at = std::ranges::find(words, '\0');
  for (const std::string_view text : {std::string_view(", the coupled joint "), std::string_view(name(other))})
    at = std::ranges::copy(text.substr(0, static_cast<std::size_t>(&words.back() - at)), at).out;
  return words;
}

}  // namespace

void Safety::raise(const Fault& fault) noexcept {
  if (fault_count_++ == 0) first_fault_ = fault;
  new_faults_[faults_raised_++ % new_faults_shown] = {fault.code, fault.joint, fault.value, fault.limit};
  (void)log_.try_push(fault);
  pending_ |= bit(fault.code);
}

void Safety::clear() noexcept {
  if (stopped_) return;
  came_back_ = false;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    joints_[i].ladder.clear();
    joints_[i].cut = 0;
    came_back_ = std::exchange(joints_[i].gave_way, false) || came_back_;
  }
  for (Ladder& ladder : foot_ladders_) ladder.clear();
  for (Ladder& ladder : channel_ladders_) ladder.clear();
  robot_.clear();
  engine_.clear();
  pending_ = cut_ = 0;
  lasting_s_ = 0;
  fault_count_ = 0;
  first_fault_ = {};
}

void Safety::imitate(const Safety& other) noexcept {
  std::copy_n(other.joints_.begin(), joint_count_, joints_.begin());
  feet_ = other.feet_;
  foot_ladders_ = other.foot_ladders_;
  std::copy_n(other.channel_ladders_.begin(), settings_.channels.size(), channel_ladders_.begin());
  imu_ = other.imu_;
  fall_ = other.fall_;
  engine_ = other.engine_;
  supply_ = other.supply_;
  robot_ = other.robot_;
  pending_ = other.pending_;
  cut_ = other.cut_;
  lasting_s_ = other.lasting_s_;
  stopped_ = other.stopped_;
  last_dt_s_ = other.last_dt_s_;
}

FaultMask Safety::watch_body(const SafetyInput& in, double dt_s) noexcept {
  return engine_.look(in.heartbeat_age_s, in.missed_ticks) | imu_.look(in.sensors.imu, in.health.imu) |
         fall_.look(in.base, in.sensors.imu, dt_s) | supply_.look(in.sensors, dt_s);
}

FaultMask Safety::watch_feet(const SafetyInput& in, double dt_s) noexcept {
  FaultMask all = 0;
  const std::uint32_t count = std::min(in.health.foot_count, in.sensors.foot_count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const FaultMask found = feet_[i].look(in.sensors.feet[i], in.health.feet[i]);
    if (found == 0 && foot_ladders_[i].idle()) continue;
    FaultMask fresh = foot_ladders_[i].update(found, dt_s, settings_.reactions, &Reaction::joint);
    for (; fresh != 0; fresh &= fresh - 1) {
      const std::uint16_t joint = i < settings_.foot_joints.size() ? settings_.foot_joints[i] : no_joint;
      Fault fault{.code = first_of(fresh), .joint = joint, .tick = in.tick};
      feet_[i].describe(in.health.feet[i], fault);
      raise(fault);
    }
    all |= found;
  }
  return all;
}

FaultMask Safety::watch_channels(const SafetyInput& in, double dt_s) noexcept {
  FaultMask all = 0;
  for (std::size_t i = 0; i < settings_.channels.size(); ++i) {
    const ChannelSample& sample = in.sensors.channels[i];
    const FaultMask found = channels_[i].look(sample, in.health.channels[i]);
    if (found == 0 && channel_ladders_[i].idle()) continue;
    FaultMask fresh = channel_ladders_[i].update(found, dt_s, settings_.reactions, &Reaction::joint);
    for (; fresh != 0; fresh &= fresh - 1) {
      Fault fault{.code = first_of(fresh), .tick = in.tick};
      channels_[i].describe(sample, fault);
      raise(fault);
    }
    all |= found;
  }
  return all;
}

FaultMask Safety::watch_joints(const SafetyInput& in, const ActuationFrame& actuation, double dt_s) noexcept {
  FaultMask all = 0;
  lost_ = 0;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    JointGuard& joint = joints_[i];
    const bool differ = modes_differ(i, actuation);
    FaultMask found =
        joint.watch.look(of_joint(in, actuation, i, dt_s)) | joint.drive.look(settings_.drives, of_drive(in, i, dt_s));
    note_if(differ && i < joint.partner, FaultCode::modes_differ, found);
    joint.writable = !differ && (found & bit(FaultCode::actuation_not_finite)) == 0;
    if ((found | joint.cut) == 0 && joint.ladder.idle()) continue;
    judge_joint(in, actuation, i, found, dt_s);
    all |= found;
  }
  return all;
}

void Safety::judge_joint(const SafetyInput& in, const ActuationFrame& actuation, std::size_t index, FaultMask found,
                         double dt_s) noexcept {
  JointGuard& joint = joints_[index];
  FaultMask fresh = joint.ladder.update(found | joint.cut, dt_s, settings_.reactions, &Reaction::joint) & found;
  for (; fresh != 0; fresh &= fresh - 1) {
    Fault fault{.code = first_of(fresh), .joint = static_cast<std::uint16_t>(index), .tick = in.tick};
    joint.watch.describe(of_joint(in, actuation, index, dt_s), fault);
    joint.drive.describe(settings_, of_drive(in, index, dt_s), fault);
    if (fault.code == FaultCode::modes_differ)
      fault.words = words_of_modes(actuation.joints[index].mode, actuation.joints[joint.partner].mode);
    raise(fault);
  }
  lost_ += ladder_level(index) >= SafetyLevel::damp ? 1 : 0;
}

// `body`: what the robot's own watches found and is still to be reported; `others`: already reported.
void Safety::judge_robot(const SafetyInput& in, FaultMask body, FaultMask others, double dt_s) noexcept {
  const FaultMask faults = body | others;
  if (faults == 0 && robot_.idle()) return;
  FaultMask fresh = robot_.update(faults, dt_s, settings_.reactions, &Reaction::robot) & body;
  for (; fresh != 0; fresh &= fresh - 1) {
    Fault fault{.code = first_of(fresh), .tick = in.tick};
    imu_.describe(in.health.imu, fault);
    fall_.describe(in.base, fault);
    engine_.describe(fault);
    supply_.describe(fault);
    if (fault.code == FaultCode::joints_lost) tell(fault, lost_, settings_.joints_lost_max);
    if (fault.code == FaultCode::emergency_stop) fault.words = stopped_by_;
    raise(fault);
  }
}

FaultMask Safety::take_stop(bool& lift) noexcept {
  lift = stop_.take_lift();
  heard_ = lift ? std::uint32_t{heard_lift} : 0;
  if (!stop_.take(stopped_by_)) return 0;
  heard_ |= heard_stop;
  lift = false;
  stopped_ = true;
  return bit(FaultCode::emergency_stop);
}

// From hold to damp after hold_s, from damp to off after damp_s: because a fault lasts, or somebody wants it. Who wants
// it does not wait in hold.
void Safety::go_down(FaultMask faults, double dt_s) noexcept {
  const bool leaving = stop_.leaving(), wanted = stopped_ || leaving;
  if (leaving) heard_ |= heard_leave;
  if (wanted) lasting_s_ = std::max(lasting_s_, settings_.hold_s);
  if (wanted) robot_.latch(SafetyLevel::damp);
  if (wanted || (faults & escalating_) != 0) {
    lasting_s_ += dt_s;
    if (lasting_s_ > settings_.hold_s) robot_.latch(SafetyLevel::damp);
    if (lasting_s_ > settings_.hold_s + settings_.damp_s) robot_.latch(SafetyLevel::off);
  } else if (robot_.level() < SafetyLevel::damp) {
    lasting_s_ = 0;
  }
}

// What a limit cut: a fault each time that it begins.
void Safety::raise_cut(const SafetyInput& in, std::size_t index, FaultMask cut, auto&& describe) noexcept {
  JointGuard& joint = joints_[index];
  joint.cut |= cut;
  cut_ |= cut;
  FaultMask fresh = joint.ladder.update(joint.cut, 0, settings_.reactions, &Reaction::joint) & cut;
  for (; fresh != 0; fresh &= fresh - 1) {
    Fault fault{.code = first_of(fresh), .joint = static_cast<std::uint16_t>(index), .tick = in.tick};
    describe(fault);
    raise(fault);
  }
}

void Safety::cut_coupling(const SafetyInput& in, CouplingLimiter& coupling, ActuationFrame& actuation) noexcept {
  JointGuard &first = joints_[coupling.joint(0)], &second = joints_[coupling.joint(1)];
  first.driven = second.driven = first.driven || second.driven;  // each drive works for both
  const FaultMask cut = coupling.limit(in.joints, actuation);
  if (cut == 0) return;
  first.last_Nm = actuation.joints[coupling.joint(0)].effort_Nm;
  second.last_Nm = actuation.joints[coupling.joint(1)].effort_Nm;
  if (first.gave_way || second.gave_way) return;  // damping is nobody's wish
  raise_cut(in, coupling.cutting_joint(), cut, [&](Fault& fault) { coupling.describe(fault); });
}

void Safety::cut_joint(const SafetyInput& in, std::size_t index, JointActuation& actuation) noexcept {
  JointGuard& joint = joints_[index];
  actuation.effort_Nm *= fall_.share();
  const JointLimiter::Input limits{in.joints.joints[index], joint.watch.derating(), joint.authority, joint.last_Nm,
                                   change_s_};
  const FaultMask cut = joint.limiter.limit(limits, actuation);
  if (cut != 0) raise_cut(in, index, cut, [&](Fault& fault) { joint.limiter.describe(limits, fault); });
}

// The usual case in a few comparisons, while nothing is wrong with the robot: nor with the joint, and what is asked is
// well within the limits.
inline bool Safety::passes(const SafetyInput& in, std::size_t index, const JointActuation& actuation) noexcept {
  JointGuard& joint = joints_[index];
  const JointGuard& partner = joints_[joint.partner];
  const bool calm = joint.ladder.idle() && (joint.partner == index || (partner.ladder.idle() && partner.writable)) &&
                    joint.writable && joint.authority == 1 && joint.cut == 0 && !joint.gave_way &&
                    actuation.mode == ActuationMode::effort;
  const JointLimiter::Input limits{in.joints.joints[index], joint.watch.derating(), 1, joint.last_Nm, change_s_};
  if (!calm || joint.limiter.passive() || !joint.limiter.free(limits, actuation.effort_Nm)) return false;
  joint.last_Nm = actuation.effort_Nm;
  joint.driven = true;
  joint.level_number = 0;
  return true;
}

// Whether the joint damps or is off in this tick. One that comes back damps once more: what is asked of it was computed
// before it could start from the measured state.
bool Safety::gives_way(std::size_t index, double dt_s, const JointActuation& actuation) noexcept {
  JointGuard& joint = joints_[index];
  const SafetyLevel level = joint_level(index);
  // The drive makes the torque in its own modes: on the way down it cannot be softened.
  const bool by_drive = actuation.mode != ActuationMode::effort && actuation.mode != ActuationMode::off;
  const bool must = level >= SafetyLevel::damp || !joint.writable || !joints_[joint.partner].writable ||
                    (by_drive && fall_.share() < 1);
  if (level >= SafetyLevel::damp) {
    joint.authority = 0;
  } else if (joint.authority < 1) {
    joint.authority = std::min(1.0, joint.authority + dt_s / settings_.recover_s);
  }
  if (must == joint.gave_way) return must;
  joint.gave_way = must;
  came_back_ = came_back_ || !must;
  return true;
}

void Safety::limit_joint(const SafetyInput& in, std::size_t index, double dt_s, JointActuation& actuation) noexcept {
  JointGuard& joint = joints_[index];
  joint.cut = 0;
  const bool passive = joint.limiter.passive();
  const bool damps = !passive && gives_way(index, dt_s, actuation);
  const bool nothing_asked = !damps && actuation.mode == ActuationMode::off;
  SafetyLevel level = joint_level(index);
  if (passive || level == SafetyLevel::off || nothing_asked) {
    actuation = {};
  } else if (damps) {
    actuation = joint.limiter.damp(in.joints.joints[index]);
  } else {
    cut_joint(in, index, actuation);
    level = joint_level(index);  // a cut is a fault
  }
  joint.last_Nm = actuation.effort_Nm;
  joint.driven = actuation.mode != ActuationMode::off;
  joint.level_number = static_cast<std::uint32_t>(level);
}

void Safety::check(const SafetyInput& in, ActuationFrame& actuation, SafetyStatus& status) noexcept {
  const double dt_s = in.dt_s > 0 && in.dt_s <= dt_max_s ? in.dt_s : 0;
  // What is written now was computed in the last tick, out of what had changed since the one before it.
  change_s_ = std::max(dt_s, std::exchange(last_dt_s_, dt_s));
  const FaultMask raised = pending_ | cut_;
  pending_ = cut_ = 0;
  came_back_ = false;
  bool lift = false;
  const FaultMask stop = take_stop(lift);
  if (in.sensors.emergency) {  // the button is an emergency stop like any other
    stopped_ = true;
    lift = false;
  }
  const FaultMask joints = watch_joints(in, actuation, dt_s);
  const FaultMask feet = watch_feet(in, dt_s) | watch_channels(in, dt_s);
  const FaultMask body =
      watch_body(in, dt_s) | bit_if(lost_ > settings_.joints_lost_max, FaultCode::joints_lost) | stop;
  const FaultMask others = raised | joints | feet;
  judge_robot(in, body, others, dt_s);
  go_down(body | others, dt_s);
  pending_ = 0;  // what was raised here has been judged here
  SafetyLevel worst = robot_.level();
  const bool calm = worst == SafetyLevel::normal && fall_.share() == 1;
  for (std::size_t i = 0; i < joint_count_; ++i) {
    if (calm && passes(in, i, actuation.joints[i])) continue;
    limit_joint(in, i, dt_s, actuation.joints[i]);
    worst = std::max(worst, static_cast<SafetyLevel>(joints_[i].level_number));
  }
  for (CouplingLimiter& coupling : couplings_) {
    cut_coupling(in, coupling, actuation);
    worst = std::max(worst, joint_level(coupling.joint(0)));
  }
  pending_ = 0;
  if (lift) {  // what is written in this tick is still what the latches allow
    const bool came_back = came_back_;
    stopped_ = false;
    clear();
    came_back_ = came_back_ || came_back;
    ++lifts_;
  }
  status.level = worst;
  status.fault_count = fault_count_;
  status.first_fault = first_fault_;
  if (status.faults_raised != faults_raised_) status.new_faults = new_faults_;
  status.faults_raised = faults_raised_;
  status.stopped = stopped_;
  status.lifts = lifts_;
  level_number_ = static_cast<std::uint32_t>(worst);
  robot_level_number_ = static_cast<std::uint32_t>(robot_.level());
}

Safety::Safety(const SafetySettings& settings, const RobotModel& model)
    : settings_(settings),
      joint_count_(model.joints.size()),
      imu_(settings),
      fall_(settings),
      engine_(settings),
      supply_(settings) {
  if (settings_.joints.size() != joint_count_) {
    throw std::invalid_argument("safety limits for " + std::to_string(settings_.joints.size()) +
                                " joints, the robot has " + std::to_string(joint_count_));
  }
  require(joint_count_ <= max_joints, "at most " + std::to_string(max_joints) + " joints");
  check_settings(settings_);
  for (std::size_t i = 0; i < joint_count_; ++i) {
    check_limits(settings_.joints[i], model.joints[i]);
    joints_[i].watch = JointWatch(settings_, settings_.joints[i]);
    joints_[i].limiter = JointLimiter(settings_, settings_.joints[i]);
    joints_[i].partner = i;
  }
  for (const Transmission& transmission : model.transmissions) {
    if (!transmission.coupled()) continue;
    const std::size_t first = transmission.joints()[0], second = transmission.joints()[1];
    require(first < joint_count_ && second < joint_count_, "a coupling of joints that the robot does not have");
    joints_[first].partner = second;
    joints_[second].partner = first;
    couplings_.emplace_back(settings_, transmission);
    set_compliance(transmission);
  }
  feet_.fill(FootWatch(settings_));
  require(settings_.channels.size() <= max_channels, "at most " + std::to_string(max_channels) + " sensors");
  for (std::size_t i = 0; i < settings_.channels.size(); ++i)
    channels_[i] = ChannelWatch(settings_, settings_.channels[i]);
  for (std::size_t code = 0; code < fault_codes; ++code) {
    if (settings_.reactions[code].escalate) escalating_ |= bit(static_cast<FaultCode>(code));
  }
}

// Springs of coupled drives, as the joints feel them: C^-1 K^-1 C^-T.
void Safety::set_compliance(const Transmission& transmission) {
  const std::vector<std::size_t>& pair = transmission.joints();
  for (std::size_t j = 0; j < 2; ++j) {
    JointWatch::Compliance compliance;
    for (std::size_t i = 0; i < 2; ++i) {
      const double spring = settings_.joints[pair[i]].spring_Nm_per_rad;
      if (spring == 0) continue;
      const double share = transmission.joint_per_drive(j, i) / spring;
      compliance.own_rad_per_Nm += share * transmission.joint_per_drive(j, i);
      compliance.partner_rad_per_Nm += share * transmission.joint_per_drive(1 - j, i);
    }
    joints_[pair[j]].watch.set_compliance(compliance);
  }
}

void Safety::declare_signals(SignalTable& table, const RobotModel& model) const {
  table.add({"safety.faults", "", "Faults since the start or the last clearing."}, &fault_count_);
  table.add({"safety.level", "", "Worst rung of robot and joints: 0 normal, 1 limited, 2 hold, 3 damp, 4 off."},
            &level_number_);
  table.add({"safety.robot_level", "", "Rung of the robot as a whole."}, &robot_level_number_);
  table.add({"safety.fall", "", "0 upright, 1 falling, 2 fallen."}, &fall_.phase_number());
  table.add({"safety.impact_m_s2", "m/s2", "Largest specific force of the last fall."}, &fall_.impact_m_s2());
  table.add({"safety.missed_ticks", "", "Ticks of the control engine missed since the start."},
            &engine_.missed_ticks());
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const std::string prefix = "safety." + model.joints[i].name;
    table.add({prefix + ".level", "", "Rung of the joint, or of the robot if that is worse."},
              &joints_[i].level_number);
    if (joints_[i].limiter.passive()) continue;
    table.add({.name = prefix + ".temperature_C",
               .unit = "C",
               .doc = "Temperature of the motor's winding, by the thermal model.",
               .slow_Hz = 10},
              &joints_[i].watch.thermal().temperature_C());
  }
}

}  // namespace kadans
