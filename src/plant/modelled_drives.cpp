#include "kadans/plant/modelled_drives.h"

#include <algorithm>
#include <cmath>

namespace kadans {

ModelledDrives::ModelledDrives(const std::vector<DriveSettings>& settings, std::size_t joints) : drives_(joints) {
  for (std::size_t i = 0; i < std::min(joints, settings.size()); ++i) {
    const DriveSettings& from = settings[i];
    drives_[i].enable_ns = std::llround(1e9 * from.enable_s);
    drives_[i].has_brake = from.brake_Nm > 0;
    if (!from.enabled && from.torque_max_Nm > 0) drives_[i].state = DriveState::ready;
  }
}

void ModelledDrives::Drive::carry_out(DriveOrder order) noexcept {
  switch (order) {
    case DriveOrder::enable:
      brake = Brake::by_itself;
      if (state == DriveState::ready) waits_ns = std::max<std::int64_t>(enable_ns, 1);
      break;
    case DriveOrder::disable:
      brake = Brake::by_itself;
      waits_ns = 0;
      state = DriveState::ready;
      break;
    case DriveOrder::brake:
      brake = Brake::closed;
      break;
    case DriveOrder::release:
      brake = Brake::open;
      break;
    case DriveOrder::none:
    case DriveOrder::reset:
    case DriveOrder::home:
      break;
  }
}

void ModelledDrives::write(const ActuationFrame& actuation) noexcept {
  const std::size_t count = std::min<std::size_t>(drives_.size(), actuation.joint_count);
  for (std::size_t i = 0; i < count; ++i) {
    Drive& drive = drives_[i];
    const DriveRequest& request = actuation.drives[i];
    if (request.is_new(drive.order_seen)) drive.carry_out(request.order);
    drive.lets_go = actuation.joints[i].mode == ActuationMode::off;
  }
}

void ModelledDrives::step(std::int64_t dt_ns) noexcept {
  for (Drive& drive : drives_) {
    if (drive.waits_ns == 0) continue;
    drive.waits_ns = std::max<std::int64_t>(drive.waits_ns - dt_ns, 0);
    if (drive.waits_ns == 0) drive.state = DriveState::enabled;
  }
}

void ModelledDrives::fill(SensorFrame& frame) const noexcept {
  JointSample* sample = frame.joints.data();
  for (const Drive& drive : drives_) {
    sample->drive = drive.state;
    sample->braked = drive.braked();
    ++sample;
  }
}

void ModelledDrives::hash(StateHash& hash) const noexcept {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (enabled(i) && !braked(i)) continue;
    hash.add(i);
    hash.add(static_cast<std::uint64_t>(drives_[i].state));
    hash.add(static_cast<std::uint64_t>(drives_[i].waits_ns));
    hash.add(static_cast<std::uint64_t>(drives_[i].brake));
  }
}

ModelledChannels::ModelledChannels(const std::vector<SensorChannel>& channels, std::uint64_t seed) {
  for (const SensorChannel& one : channels)
    channels_.push_back({one.value, one.noise, std::llround(1e9 * one.period_s), {seed, "plant/sensor/" + one.name}});
}

void ModelledChannels::sample(std::int64_t time_ns) {
  for (Channel& channel : channels_) {
    if (time_ns < channel.due_ns) continue;
    channel.due_ns = time_ns + channel.period_ns;
    channel.sample.value = channel.value + (channel.noise > 0 ? channel.noise * channel.stream.normal() : 0);
    ++channel.sample.sequence;
  }
}

void ModelledChannels::fill(SensorFrame& frame) const noexcept {
  frame.channel_count = static_cast<std::uint32_t>(channels_.size());
  for (std::size_t i = 0; i < channels_.size(); ++i) frame.channels[i] = channels_[i].sample;
}

}  // namespace kadans
