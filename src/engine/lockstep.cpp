#include "kadans/engine/lockstep.h"

#include <stdexcept>

namespace kadans {

Lockstep::Lockstep(const EngineSettings& settings, Plant& plant, ControlEngine& control, BehaviorEngine& behaviors)
    : plant_(plant),
      control_(control),
      behaviors_(behaviors),
      control_period_ns_(settings.control_period_ns()),
      behavior_divisor_(settings.behavior_divisor()) {
  if (behavior_divisor_ == 0) {
    throw std::invalid_argument("the behavior period must be a whole multiple of the control period");
  }
}

void Lockstep::step() {
  const bool behaviors_due = control_.ticks() % behavior_divisor_ == 0;
  const std::int64_t began_ns = wall_.now_ns();
  control_.tick(clock_.now_ns(), 1e-9 * static_cast<double>(control_period_ns_));
  control_tick_cost_.add(wall_.now_ns() - began_ns);
  if (behaviors_due) behaviors_.tick(clock_.now_ns());
  plant_.step(control_period_ns_);
  clock_.advance(control_period_ns_);
}

}  // namespace kadans
