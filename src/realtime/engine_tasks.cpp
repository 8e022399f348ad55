#include "engine_tasks.h"

namespace kadans {

bool ControlTask::beat(const Beat& beat) {
  const std::int64_t began_ns = wall_.now_ns();
  engine_.tick(beat.woke_ns, beat.dt_s, beat.missed);
  cost_.add(wall_.now_ns() - began_ns);
  ticks_.add(1);
  if (after_ != nullptr) after_->beside_tick(beat.woke_ns);
  return true;
}

void ControlTask::prepare() noexcept { engine_.rehearse(); }

bool BehaviorTask::beat(const Beat& beat) {
  if (before_ != nullptr) before_->beside_tick(beat.woke_ns);
  engine_.tick(beat.woke_ns);
  return true;
}

}  // namespace kadans
