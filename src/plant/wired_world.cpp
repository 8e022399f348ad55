#include "kadans/plant/wired_world.h"

namespace kadans {

bool WiredWorld::open(bool (*give_up)() noexcept) {
  set_time(time_ns_);
  started_ = true;
  return open_driver(give_up);
}

void WiredWorld::read(SensorFrame& sensors) noexcept {
  if (!started_) start();
  set_time(time_ns_);
  inner().read(sensors);
  take(sensors);
  sensors.time_ns = time_ns_;
}

void WiredWorld::write(const ActuationFrame& actuation) noexcept {
  if (!silent) plant().write(actuation);
}

void WiredWorld::step(std::int64_t dt_ns) {
  if (!started_) start();
  faults_.happen(drives(), time_ns_);
  begin_step();
  drives().drive(inner());
  world_.step(dt_ns);
  drives().pass(dt_ns);
  time_ns_ += dt_ns;
  end_step();
}

void WiredWorld::hash(StateHash& hash) const noexcept {
  WorldAround::hash(hash);
  hash.add(passed());
}

}  // namespace kadans
