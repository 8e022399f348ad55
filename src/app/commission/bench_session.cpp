#include "bench_session.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr double still_within_rad = 0.004, still_for_s = 0.4;

}  // namespace

BenchSession::BenchSession(Bench& bench, Person& person, const RobotModel& model, const Settings& settings)
    : bench_(bench), person_(person), model_(model), settings_(settings), watches_(model.joints.size()) {
  bench_.read(sensors_);
  settle(10);
}

void BenchSession::tick(std::size_t joint, double effort_Nm, bool acts) {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) actuation_.joints[i] = {};
  actuation_.joint_count = static_cast<std::uint32_t>(model_.joints.size());
  if (acts && std::isfinite(effort_Nm)) {
    const double most_Nm = effort_max_Nm(joint);
    actuation_.joints[joint] = {.effort_Nm = std::clamp(effort_Nm, -most_Nm, most_Nm), .mode = ActuationMode::effort};
  }
  if (homed_ != nullptr) {  // an order needs a frame of its own
    if (!acts && homing_ticks_ > 0) order(joint, DriveOrder::disable);
    homing_ticks_ = acts ? homing_ticks_ + 1 : 0;
    if (homing_ticks_ == 1) order(joint, DriveOrder::enable);
    if (homing_ticks_ == 20) order(joint, DriveOrder::home);
  }
  bench_.write(actuation_);
  bench_.read(sensors_);
  sight_.dt_s = settings_.period_s;
  sight_.time_s += settings_.period_s;
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    watches_[i].look(sensors_.joints[i], sensors_.time_ns);
    sight_.position_rad[i] = sensors_.joints[i].position_rad;
    sight_.velocity_rad_s[i] = watches_[i].velocity_rad_s();
    sight_.effort_Nm[i] = sensors_.joints[i].motor_effort_Nm;
    ranges_[i].least_rad = std::min(ranges_[i].least_rad, sight_.position_rad[i]);
    ranges_[i].most_rad = std::max(ranges_[i].most_rad, sight_.position_rad[i]);
  }
  if (homed_ != nullptr) *homed_ = sensors_.joints[homing_joint_].homed;
  if (person_.gone()) throw PersonGone{};
}

void BenchSession::wait(double seconds) {
  for (double passed_s = 0; passed_s < seconds; passed_s += settings_.period_s) tick(0, 0, false);
}

// At rest but for what encoders tremble.
bool BenchSession::still() {
  still_s_ += settings_.period_s;
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
  for (double passed_s = 0; passed_s < seconds && !still(); passed_s += settings_.period_s) tick(0, 0, false);
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
  for (std::size_t i = 0; i < model_.joints.size(); ++i) ranges_[i] = {sight_.position_rad[i], sight_.position_rad[i]};
  person_.ask(question);
  for (;;) {
    tick(0, 0, false);
    const std::optional<std::string> answer = person_.answer(bench_.now_ns());
    if (!answer) continue;
    if (question.answers.empty() || std::ranges::find(question.answers, *answer) != question.answers.end())
      return *answer;
    std::string known;
    for (const std::string& one : question.answers) known += (known.empty() ? "" : ", ") + one;
    person_.hear("'" + *answer + "' is no answer here; there are: " + known);
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

BenchSession::Stop BenchSession::look_for_stop(std::size_t joint, bool far) {
  for (std::size_t i = 0; i < model_.joints.size(); ++i) {
    stopped_joint_ = i;
    if (far && i == joint) continue;
    if (std::abs(sight_.position_rad[i] - held_from_rad_[i]) > settings_.away_rad) return Stop::too_far;
  }
  stopped_joint_ = joint;
  if (sensors_.joints[joint].drive == DriveState::fault) return Stop::fault;
  return watches_[joint].silent() ? Stop::silent : Stop::none;
}

BenchSession::Stop BenchSession::hold(const Question& question, std::size_t joint, Push& push, bool far) {
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
  Stop stop = Stop::none;
  for (;;) {
    const Person::Hand hand = person_.hand(bench_.now_ns(), push.complete() || stop != Stop::none);
    if (hand == Person::Hand::done) break;
    const bool holds = hand == Person::Hand::holds && stop == Stop::none && !sensors_.emergency;
    if (!holds) begun = false, still_s_ = 0;
    // First its drive is on without torque: what a brake held goes where gravity takes it.
    if (holds && !begun) {
      begun = still();
      held_from_rad_ = sight_.position_rad;
      if (begun) push.begin(sight_);
    }
    tick(joint, begun ? push.step(sight_) : 0, holds);
    if (holds) stop = look_for_stop(joint, far);
  }
  settle(3);
  return stop;
}

std::string BenchSession::why(Stop stop) const {
  const std::string name = model_.joints[stopped_joint_].name;
  const JointSample& sample = sensors_.joints[stopped_joint_];
  switch (stop) {
    case Stop::fault:
      return "drive '" + name + "' has a fault, code " + std::to_string(sample.code) +
             (settings_.words == nullptr ? "" : ": " + std::string(settings_.words(sample.code)));
    case Stop::silent:
      return "drive '" + name + "' tells nothing any more";
    case Stop::too_far:
      return "encoder '" + name + "' went " + number_text(std::round(settings_.away_rad * 57.296)) +
             " degrees from where it stood: that is further than it was pushed";
    case Stop::none:
      break;
  }
  return "";
}

}  // namespace kadans
