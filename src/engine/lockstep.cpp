#include "lockstep.h"

#include <stdexcept>
#include <utility>

namespace kadans {

Lockstep::Lockstep(const EngineSettings& settings, World& world, ControlEngine& control, BehaviorEngine& behaviors)
    : world_(world),
      control_(control),
      behaviors_(behaviors),
      control_period_ns_(settings.control_period_ns()),
      behavior_period_ns_(settings.behavior_divisor() * settings.control_period_ns()) {
  if (behavior_period_ns_ == 0) {
    throw std::invalid_argument("the behavior period must be a whole multiple of the control period");
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
  const std::int64_t began_ns = wall_.now_ns();
  control_.tick(now_ns, 1e-9 * static_cast<double>((1 + missed) * control_period_ns_), missed);
  control_tick_cost_.add(wall_.now_ns() - began_ns);
  if (now_ns >= behaviors_due_ns_) {
    if (!behaviors_silent_) behaviors_.tick(now_ns);
    behaviors_due_ns_ = (now_ns / behavior_period_ns_ + 1) * behavior_period_ns_;
  }
  pass_period();
}

}  // namespace kadans
