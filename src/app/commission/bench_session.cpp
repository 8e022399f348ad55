#include "bench_session.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "engine/behavior_log.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double still_within_rad = 0.004, still_for_s = 0.4;

}  // namespace

BenchSession::BenchSession(Bench& bench, Person& person, const RobotModel& model, const Settings& settings)
    : bench_(bench),
      person_(person),
      model_(model),
      settings_(settings),
      watches_(model.joints.size()),
      first_ns_(bench.now_ns()) {
  bench_.read(sensors_);
  settle(10);
}

void BenchSession::tick(std::size_t joint, double effort_Nm, bool acts) {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) actuation_.joints[i] = {};
  actuation_.joint_count = static_cast<std::uint32_t>(model_.joints.size());
  if (acts && std::isfinite(effort_Nm)) {
    const double most_Nm = effort_max_Nm(joint), bounded_Nm = std::clamp(effort_Nm, -most_Nm, most_Nm);
    actuation_.joints[joint] = {.effort_Nm = bounded_Nm, .mode = ActuationMode::effort};
    if (const Transmission* const pair = pair_of(joint)) {
      const auto& joints = pair->joints();
      const Transmission::Pair joint_Nm = pair->joint_effort_Nm(joints[0] == joint ? Transmission::Pair{bounded_Nm, 0}
                                                                                   : Transmission::Pair{0, bounded_Nm});
      for (std::size_t k = 0; k < 2; ++k)
        actuation_.joints[joints[k]] = {.effort_Nm = joint_Nm[k], .mode = ActuationMode::effort};
    }
  }
  if (homed_ != nullptr) {  // an order needs a frame of its own
    if (!acts && homing_ticks_ > 0) order(joint, DriveOrder::disable);
    homing_ticks_ = acts ? homing_ticks_ + 1 : 0;
    if (homing_ticks_ == 1) order(joint, DriveOrder::enable);
    if (homing_ticks_ == 20) order(joint, DriveOrder::home);
  }
  bench_.write(actuation_);
  bench_.read(sensors_);
  // A machine that is busy lets more time pass.
  const double time_s = seconds_between(first_ns_, bench_.now_ns());
  sight_.dt_s = std::max(time_s - sight_.time_s, 0.1 * settings_.period_s);
  sight_.time_s = time_s;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    watches_[i].look(sensors_.joints[i], sensors_.time_ns);
    const double at_rad = sensors_.joints[i].position_rad;
    ranges_[i] = {std::min(ranges_[i].least_rad, at_rad), std::max(ranges_[i].most_rad, at_rad)};
  }
  see();
  if (homed_ != nullptr) *homed_ = sensors_.joints[homing_joint_].homed;
  if (person_.gone()) throw PersonGone{};
}

void BenchSession::see() {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    sight_.position_rad[i] = sensors_.joints[i].position_rad;
    sight_.velocity_rad_s[i] = watches_[i].velocity_rad_s();
    sight_.since_s[i] = watches_[i].since_s();
    sight_.effort_Nm[i] = sensors_.joints[i].motor_effort_Nm;
  }
  for (const Transmission& pair : model_.transmissions) {
    if (!by_drives_ || !pair.coupled()) continue;
    const std::size_t a = pair.joints()[0], b = pair.joints()[1];
    const auto both = [&](auto& of, Transmission::Pair is) { of[a] = is[0], of[b] = is[1]; };
    both(sight_.position_rad, pair.drive_position_rad({sight_.position_rad[a], sight_.position_rad[b]}));
    both(sight_.velocity_rad_s, pair.drive_velocity_rad_s({sight_.velocity_rad_s[a], sight_.velocity_rad_s[b]}));
    both(sight_.effort_Nm, pair.drive_effort_Nm({sight_.effort_Nm[a], sight_.effort_Nm[b]}));
  }
}

void BenchSession::wait(double seconds) {
  for (const double from_s = sight_.time_s; sight_.time_s - from_s < seconds;) tick(0, 0, false);
}

// At rest but for what encoders tremble.
bool BenchSession::still() {
  still_s_ += sight_.dt_s;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    if (!(std::abs(sight_.position_rad[i] - still_at_rad_[i]) <= still_within_rad)) {
      still_s_ = 0;
      still_at_rad_ = sight_.position_rad;
    }
  }
  return still_s_ >= still_for_s;
}

void BenchSession::settle(double seconds) {
  still_s_ = 0;
  for (const double from_s = sight_.time_s; sight_.time_s - from_s < seconds && !still();) tick(0, 0, false);
}

void BenchSession::order(std::size_t joint, DriveOrder order) {
  DriveRequest& request = actuation_.drives[joint];
  request = {.order = order, .number = static_cast<std::uint8_t>(request.number + 1)};
}

void BenchSession::watch_homing(std::size_t joint, bool* homed) {
  homing_joint_ = joint;
  homed_ = homed;
  homing_ticks_ = 0;
}

std::string BenchSession::ask(const Question& question) {
  for (std::size_t i = 0; i < model_.joints.size(); ++i)
    ranges_[i] = {sensors_.joints[i].position_rad, sensors_.joints[i].position_rad};
  person_.ask(question);
  for (;;) {
    tick(0, 0, false);
    const std::optional<std::string> answer = person_.answer(bench_.now_ns());
    if (!answer) continue;
    if (question.answers.empty() || std::ranges::find(question.answers, *answer) != question.answers.end())
      return *answer;
    person_.hear("'" + *answer + "' is no answer here; there are: " + listed(question.answers));
    person_.ask(question);
  }
}

double BenchSession::ask_number(Question question, double min, double max) {
  question.about = Question::About::number;
  for (;;) {
    const std::string answer = ask(question);
    char* end = nullptr;
    const double value = std::strtod(answer.c_str(), &end);
    if (end != answer.c_str() && *end == '\0' && value >= min && value <= max) return value;
    person_.hear("'" + answer + "' is no number from " + number_text(min) + " to " + number_text(max));
  }
}

// "": nothing.
std::string BenchSession::look_for_stop(std::size_t joint, bool far) const {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    const bool near = std::abs(sight_.position_rad[i] - held_from_rad_[i]) <= settings_.away_rad &&
                      std::abs(sensors_.joints[i].position_rad - joints_held_from_rad_[i]) <= settings_.away_rad;
    if ((far && i == joint) || near) continue;
    return "encoder '" + model_.joints[i].name + "' went " + number_text(std::round(settings_.away_rad * 57.296)) +
           " degrees from where it stood: that is further than it was pushed";
  }
  const PushedJoint::Stop stop = watches_[joint].stopped();
  if (stop == PushedJoint::Stop::none) return "";
  return "it " + stop_words(stop, sensors_.joints[joint].code, settings_.words);
}

std::string BenchSession::hold(const Question& question, std::size_t joint, Push& push, bool far) {
  // A watchdog that bit while nobody was driven is no fault of this joint.
  if (sensors_.joints[joint].drive == DriveState::fault) {
    order(joint, DriveOrder::reset);
    wait(0.2);
    order(joint, DriveOrder::enable);
    wait(0.2);
  }
  person_.ask_to_hold(question);
  bool begun = false;
  still_s_ = 0;
  std::string stop;
  for (;;) {
    const Person::Hand hand = person_.hand(bench_.now_ns(), push.complete() || !stop.empty());
    if (hand == Person::Hand::done) break;
    const bool holds = hand == Person::Hand::holds && stop.empty() && !sensors_.emergency;
    if (!holds) begun = false, still_s_ = 0;
    // First its drive is on without torque: what a brake held goes where gravity takes it.
    if (holds && !begun) {
      begun = still();
      held_from_rad_ = sight_.position_rad;
      for (std::size_t i = 0; i < model_.joints.size(); ++i) joints_held_from_rad_[i] = sensors_.joints[i].position_rad;
      if (begun) push.begin(sight_);
    }
    tick(joint, begun ? push.step(sight_) : 0, holds);
    if (holds) stop = look_for_stop(joint, far);
    if (holds && !push.aborted().empty()) stop = std::string(push.aborted()) + ": it was let go at once";
  }
  settle(3);
  return stop;
}

}  // namespace kadans
