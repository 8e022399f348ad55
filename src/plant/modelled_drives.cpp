#include "kadans/plant/modelled_drives.h"

#include <algorithm>
#include <cmath>

namespace kadans {

ModelledDrives::ModelledDrives(const std::vector<DriveSettings>& settings, std::size_t joints) : drives_(joints) {
  for (std::size_t i = 0; i < std::min(joints, settings.size()); ++i) {
    const DriveSettings& from = settings[i];
    drives_[i].enable_ns = std::llround(1e9 * from.enable_s);
    drives_[i].has_brake = from.brake_Nm > 0;
    if (!from.enabled && from.torque_max_Nm > 0) drives_[i].become(DriveState::ready);
  }
}

// An enabled drive holds the joint itself.
void ModelledDrives::Drive::become(DriveState next) noexcept {
  state = next;
  braked = has_brake && next != DriveState::enabled;
}

void ModelledDrives::Drive::carry_out(DriveOrder order) noexcept {
  switch (order) {
    case DriveOrder::enable:
      if (state == DriveState::ready) waits_ns = std::max<std::int64_t>(enable_ns, 1);
      break;
    case DriveOrder::disable:
      waits_ns = 0;
      become(DriveState::ready);
      break;
    case DriveOrder::brake:
    case DriveOrder::release:
      braked = has_brake && order == DriveOrder::brake;
      break;
    case DriveOrder::none:
    case DriveOrder::reset:
    case DriveOrder::home:
      break;
  }
}

void ModelledDrives::write(const ActuationFrame& actuation) noexcept {
  for (std::size_t i = 0; i < std::min<std::size_t>(drives_.size(), actuation.joint_count); ++i) {
    const DriveRequest& request = actuation.drives[i];
    if (request.is_new(drives_[i].order_seen)) drives_[i].carry_out(request.order);
  }
}

void ModelledDrives::step(std::int64_t dt_ns) noexcept {
  for (Drive& drive : drives_) {
    if (drive.waits_ns == 0) continue;
    drive.waits_ns = std::max<std::int64_t>(drive.waits_ns - dt_ns, 0);
    if (drive.waits_ns == 0) drive.become(DriveState::enabled);
  }
}

void ModelledDrives::fill(SensorFrame& frame) const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    frame.joints[i].drive = drives_[i].state;
    frame.joints[i].braked = drives_[i].braked;
  }
}

void ModelledDrives::hash(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (enabled(i) && !braked(i)) continue;
    hash.add(i);
    hash.add(static_cast<std::uint64_t>(drives_[i].state));
    hash.add(static_cast<std::uint64_t>(drives_[i].waits_ns));
    hash.add(std::uint64_t{drives_[i].braked});
  }
}

}  // namespace kadans
