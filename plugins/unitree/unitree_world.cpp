#include "unitree_world.h"

#include <algorithm>
#include <utility>

namespace unitree {

void VirtualLink::pass(const Packet& packet) noexcept {
  passed_.add(now_ns_);
  for (const std::uint32_t word : packet.used()) passed_.add(word);
}

bool VirtualLink::send(const Packet& command) noexcept {
  pass(command);
  (void)robot_.hear(command);
  return true;
}

bool VirtualLink::take(Packet& state) noexcept {
  if (!std::exchange(waits_, false)) return false;
  state = state_;
  return true;
}

void VirtualLink::exchange() noexcept {
  waits_ = robot_.tell(state_) || waits_;
  if (waits_) pass(state_);
  if (!robot_.second_writer()) return;
  robot_.second_command(second_);
  (void)robot_.hear(second_);
  ++foreign_;
}

UnitreeWorld::UnitreeWorld(std::unique_ptr<kadans::World> model, const Settings& settings,
                           const kadans::PlantSite& site)
    : WiredWorld(std::move(model)), robot_(settings, site), period_ns_(settings.period_ns()) {
  auto link = std::make_unique<VirtualLink>(robot_);
  link_ = link.get();
  plant_ = std::make_unique<UnitreePlant>(settings, site, std::move(link));
}

bool UnitreeWorld::open_driver(bool (*give_up)() noexcept) {
  robot_.look(inner());
  link_->exchange();
  return plant_->open(give_up);
}

void UnitreeWorld::take(kadans::SensorFrame& sensors) noexcept {
  plant_->read(measured_);
  kadans::copy_first(measured_.joints, measured_.joint_count, sensors.joints);
  kadans::copy_first(measured_.feet, measured_.foot_count, sensors.feet);
  sensors.imu = measured_.imu;
  sensors.supply_V = measured_.supply_V;
}

void UnitreeWorld::begin_step() {
  if (time_ns() < next_ns_) return;
  next_ns_ += period_ns_;
  set_time(time_ns());
  robot_.look(inner());
  link_->exchange();
  if (!silent) plant_->run_cycle();
}

}  // namespace unitree
