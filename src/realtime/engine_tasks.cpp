
#include "engine_tasks.h"

#include <algorithm>

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

LinkedPlant::LinkedPlant(PlantExchange& exchange, World& world) : exchange_(exchange) {
  SensorFrame sensors;
  world.robot(0).read(sensors);
  exchange_.sensors.publish(sensors);
  exchange_.truth.publish(world.robot(0).truth());
}

// A signal asks for itself: what is large is copied when there is another one, not each time.
const PlantTruth& LinkedPlant::truth() const noexcept {
  if (!exchange_.truth.has_news()) return truth_;
  const auto newest = exchange_.truth.read();
  return truth_ = *newest;
}

bool PlantTask::beat(const Beat& beat) {
  const auto actuation = exchange_.actuation.read();
  world_.robot(0).write(*actuation);
  const std::uint32_t steps = std::min(1 + beat.missed, catch_up_max);
  lost_periods_.add(1 + std::uint64_t{beat.missed} - steps);
  for (std::uint32_t i = 0; i < steps; ++i) {  // a control tick may come between any two
    world_.step(period_ns_);
    world_.robot(0).read(sensors_);
    exchange_.sensors.publish(sensors_);
    exchange_.truth.publish(world_.robot(0).truth());
  }
  return true;
}

}  // namespace kadans
