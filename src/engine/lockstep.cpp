#include "lockstep.h"

#include <stdexcept>
#include <utility>

namespace kadans {

Lockstep::Lockstep(const EngineSettings& settings, World& world, ControlEngine& control, BehaviorEngine& behaviors,
                   Supervising* supervisor)
    : world_(world), control_period_ns_(settings.control_period_ns()) {
  add(settings, control, behaviors, supervisor);
}

void Lockstep::add(const EngineSettings& settings, ControlEngine& control, BehaviorEngine& behaviors,
                   Supervising* supervisor) {
  if (settings.control_period_ns() != control_period_ns_) {
    throw std::invalid_argument("the control period must be the same for all robots of a world");
  }
  const std::int64_t behavior_period_ns = settings.behavior_divisor() * control_period_ns_;
  if (behavior_period_ns == 0) {
    throw std::invalid_argument("the behavior period must be a whole multiple of the control period");
  }
  robots_.insert(robots_.begin(), {&control, &behaviors, supervisor, behavior_period_ns});
}

void Lockstep::silence(const BehaviorEngine& of, Silent silent) noexcept {
  for (Engines& robot : robots_) {
    if (robot.behaviors == &of) robot.silent = silent;
  }
}

void Lockstep::pass_period() {
  world_.step(control_period_ns_);
  clock_.advance(control_period_ns_);
}

void Lockstep::step() {
  const std::uint32_t missed = std::exchange(missed_, 0);
  for (std::uint32_t i = 0; i < missed; ++i) pass_period();
  const std::int64_t now_ns = clock_.now_ns();
  for (const Engines& robot : robots_) {
    const std::int64_t began_ns = wall_.now_ns();
    robot.control->tick(now_ns, 1e-9 * static_cast<double>((1 + missed) * control_period_ns_), missed);
    control_tick_cost_.add(wall_.now_ns() - began_ns);
  }
  for (Engines& robot : robots_) {
    if (now_ns < robot.behaviors_due_ns) continue;
    if (!robot.silent.behaviors) robot.behaviors->tick(now_ns);
    robot.behaviors_due_ns = (now_ns / robot.behavior_period_ns + 1) * robot.behavior_period_ns;
  }
  for (Engines& robot : robots_) {
    if (robot.supervisor == nullptr || now_ns < robot.supervisor_due_ns) continue;
    if (!robot.silent.supervisor) robot.supervisor->tick(now_ns);
    const std::int64_t period_ns = robot.supervisor->period_ns();
    robot.supervisor_due_ns = (now_ns / period_ns + 1) * period_ns;
  }
  pass_period();
}

}  // namespace kadans
