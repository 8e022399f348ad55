#include "kadans/engine/lockstep.h"

#include <cmath>
#include <stdexcept>

namespace kadans {

Lockstep::Lockstep(const EngineSettings& settings, Plant& plant, ControlEngine& control, BehaviorEngine& behaviors)
    : plant_(plant),
      control_(control),
      behaviors_(behaviors),
      control_period_ns_(std::llround(settings.control_period_s * 1e9)) {
  const std::int64_t behavior_period_ns = std::llround(settings.behavior_period_s * 1e9);
  if (control_period_ns_ <= 0 || behavior_period_ns <= 0 || behavior_period_ns % control_period_ns_ != 0) {
    throw std::invalid_argument("the behavior period must be a whole multiple of the control period");
  }
  control_ticks_per_behavior_tick_ = static_cast<std::uint64_t>(behavior_period_ns / control_period_ns_);
}

void Lockstep::step() {
  const bool behaviors_due = control_.ticks() % control_ticks_per_behavior_tick_ == 0;
  control_.tick(clock_.now_ns(), 1e-9 * static_cast<double>(control_period_ns_));
  if (behaviors_due) behaviors_.tick(clock_.now_ns());
  plant_.step(control_period_ns_);
  clock_.advance(control_period_ns_);
}

}  // namespace kadans
