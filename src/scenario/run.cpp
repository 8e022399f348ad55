
#include "run.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <utility>

namespace kadans {
namespace {

template <typename T>
void keep(std::vector<T>& all, std::size_t kept_max, T one) {
  if (all.size() >= 2 * kept_max) all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(kept_max));
  all.push_back(std::move(one));
}

}  // namespace

void RunLog::tell(const Line& line) {
  if (line.transition != nullptr) return keep(transitions_, kept_max_, *line.transition);
  errors_ = errors_ || line.severity == Severity::error;
  keep(lines_, kept_max_, {line.time_ns, line.severity, std::string(line.behavior), std::string(line.text)});
}

RunSteps::RunSteps(const RunParts& parts) : parts_(parts) {
  std::size_t from = 0;
  for (const SignalId left_out : parts_.unhashed) {
    hashed_.emplace_back(from, left_out - from);
    from = left_out + 1;
  }
  hashed_.emplace_back(from, std::dynamic_extent);
}

void RunSteps::step() {
  parts_.begin_step();
  parts_.lockstep.step();
  const std::span<const double> row = parts_.control.row();
  for (const auto& [first, count] : hashed_) hash_.add(row.subspan(first, count));
  parts_.world.hash(hash_);
  for (const RunParts& other : parts_.others) {
    if (other.faulty != nullptr) other.faulty->hash_held_back(hash_);
  }
}

RunMark RunSteps::mark() const noexcept { return {parts_.control.ticks(), parts_.lockstep.time_ns(), hash_.value()}; }

namespace {

class Run {
 public:
  Run(const RunParts& parts, Checks& checks, const std::vector<RunObserver*>& observers)
      : steps_(parts), parts_(parts), checks_(checks), observers_(observers) {}

  void go(double duration_s) {
    const std::int64_t end_ns = std::llround(duration_s * 1e9);
    const WallClock wall;
    const std::int64_t began_ns = wall.now_ns();
    try {
      while (parts_.lockstep.time_ns() < end_ns && !stop_asked()) step();
    } catch (const std::exception& error) {
      result_.error = error.what();
    }
    result_.wall_s = 1e-9 * static_cast<double>(wall.now_ns() - began_ns);
    result_.interrupted = stop_asked();
  }

  RunResult finish() {
    const TickStatistics& cost = parts_.lockstep.control_tick_cost();
    result_.duration_s = 1e-9 * static_cast<double>(parts_.lockstep.time_ns());
    result_.realtime_factor = result_.wall_s > 0 ? result_.duration_s / result_.wall_s : 0;
    result_.control_ticks = parts_.control.ticks();
    result_.behavior_ticks = parts_.behaviors.ticks();
    result_.state_hash = steps_.mark().state_hash;
    result_.tick = {cost.percentile_ns(0.5), cost.percentile_ns(0.99), static_cast<double>(cost.max_ns())};
    result_.commands_sent = parts_.behaviors.commands().sent();
    result_.commands_refused = parts_.behaviors.commands().refused() + parts_.control.inbox().state().refused;
    result_.checks = checks_.results();
    result_.passed = std::ranges::all_of(result_.checks, &CheckResult::passed) && result_.error.empty() &&
                     !result_.interrupted && !parts_.log.has_errors();
    return std::move(result_);
  }

 private:
  bool stop_asked() const { return std::ranges::any_of(observers_, &RunObserver::stop_asked); }

  void step() {
    steps_.step();
    const double time_s = 1e-9 * static_cast<double>(parts_.control.state().time_ns);
    const std::span<const double> row = parts_.control.row();
    checks_.update(time_s, row);
    for (RunObserver* observer : observers_) observer->tick(time_s, row);
    const RunMark mark = steps_.mark();
    for (RunObserver* observer : observers_) observer->between_ticks(mark);
    take_residual(time_s);
    take_faults(parts_, 0);
    for (std::size_t i = 0; i < parts_.others.size(); ++i) take_faults(parts_.others[i], i + 1);
  }

  void take_residual(double time_s) {
    double residual_m_s = parts_.robot.truth().residual_m_s;
    for (const RunParts& other : parts_.others) residual_m_s = std::max(residual_m_s, other.robot.truth().residual_m_s);
    if (residual_m_s > residual_trusted_m_s) ++result_.unsettled_steps;
    if (residual_m_s <= result_.residual_max_m_s) return;
    result_.residual_max_m_s = residual_m_s;
    result_.residual_max_at_s = time_s;
  }

  void take_faults(const RunParts& robot, std::size_t index) {
    const std::int64_t time_ns = robot.control.state().time_ns;
    for (Fault fault; robot.control.safety().log().try_pop(fault);) {
      fault.robot = static_cast<std::uint16_t>(index);
      ToldFault what = told(fault, robot.model, time_ns, robot.name);
      for (RunObserver* observer : observers_) observer->fault(fault);
      result_.faults.push_back({fault, std::move(what)});
    }
  }

  RunSteps steps_;
  const RunParts& parts_;
  Checks& checks_;
  const std::vector<RunObserver*>& observers_;
  RunResult result_;
};

}  // namespace

void RunParts::begin_step() const {
  truth.update(1e-9 * static_cast<double>(lockstep.time_ns()), control.row());
  if (disturbances != nullptr) disturbances->apply(lockstep, behaviors, world, robot);
  if (joystick != nullptr) control.exchange().joystick.publish(joystick->at(lockstep.time_ns()));
  if (sight != nullptr) control.exchange().ball.publish(sight->at(lockstep.time_ns(), robot.truth()));
  for (SimulatedPerception* one : perception) one->look(lockstep.time_ns(), robot.truth(), *observed);
  for (RecordedPerception* one : recorded) one->look(lockstep.time_ns(), *observed);
  for (const RunParts& other : others) other.begin_step();
}

RunResult run_scenario(const RunParts& parts, double duration_s, Checks& checks,
                       const std::vector<RunObserver*>& observers) {
  Run run(parts, checks, observers);
  run.go(duration_s);
  return run.finish();
}

}  // namespace kadans
