#include "servo_world.h"

#include <algorithm>
#include <array>

namespace kadans::dynamixel {

bool VirtualPort::send(Octets bytes) noexcept {
  passed_.pass(bytes, now_);
  bus_.receive(bytes, now_, baud_);
  sent += bytes.size();
  return true;
}

std::size_t VirtualPort::receive(std::span<std::uint8_t> into, std::int64_t until_ns) noexcept {
  if (bus_.due_ns() > until_ns) {
    now_ = std::max(now_, until_ns);
    return 0;
  }
  now_ = std::max(now_, bus_.due_ns());
  std::size_t count = bus_.take(into, now_);
  if (twice > 0 && count >= twice && count + twice <= into.size()) {
    std::copy_backward(into.begin(), into.begin() + static_cast<std::ptrdiff_t>(count),
                       into.begin() + static_cast<std::ptrdiff_t>(count + twice));
    count += twice;
  }
  passed_.pass(into.first(count), now_);
  received += count;
  return count;
}

void VirtualPort::discard() noexcept {
  std::array<std::uint8_t, 4096> old;
  while (bus_.take(old, now_) > 0) {
  }
}

ServoWorld::ServoWorld(std::unique_ptr<World> model, const DynamixelSettings& settings, const PlantSite& site,
                       const DynamixelSettings* there)
    : WiredWorld(std::move(model)), servos_(there == nullptr ? settings : *there, site, site.seed) {
  std::vector<std::unique_ptr<SerialPort>> ports;
  for (std::size_t i = 0; i < settings.ports.size(); ++i) {
    auto port = std::make_unique<VirtualPort>(servos_.bus(i), settings.ports[i].baud);
    ports_.push_back(port.get());
    ports.push_back(std::move(port));
  }
  plant_ = std::make_unique<DynamixelPlant>(settings, site, std::move(ports), DynamixelPlant::Threads::none);
  servos_.look(inner());
}

void ServoWorld::set_time(std::int64_t now_ns) noexcept {
  for (VirtualPort* port : ports_) port->set(now_ns);
}

bool ServoWorld::open_driver(bool (*give_up)() noexcept) {
  set_time(-1'000'000'000'000);  // it takes as long as it takes
  if (!plant_->open(give_up)) return false;
  set_time(-plant_->period_ns());
  plant_->run_cycles();
  set_time(0);
  plant_->read(held_);
  return true;
}

void ServoWorld::take(SensorFrame& sensors) noexcept {
  if (time_ns() >= visible_ns_) plant_->read(held_);
  for (std::size_t i = 0; i < held_.joint_count; ++i) {
    if (held_.joints[i].sequence > 0) sensors.joints[i] = held_.joints[i];
  }
  sensors.supply_V = held_.supply_V;
}

void ServoWorld::begin_step() {
  servos_.look(inner());
  if (time_ns() < next_ns_) return;
  set_time(time_ns());
  if (!silent) plant_->run_cycles();
  visible_ns_ = time_ns();
  for (const VirtualPort* port : ports_) visible_ns_ = std::max(visible_ns_, port->now_ns());
  cycle_ns = visible_ns_ - time_ns();
  next_ns_ += plant_->period_ns();
  while (next_ns_ < visible_ns_) next_ns_ += plant_->period_ns();
}

std::uint64_t ServoWorld::passed() const noexcept {
  StateHash all;
  for (const VirtualPort* port : ports_) all.add(port->passed());
  return all.value();
}

}  // namespace kadans::dynamixel
