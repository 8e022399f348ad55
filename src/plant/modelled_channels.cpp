#include "kadans/plant/modelled_channels.h"

#include <cmath>

namespace kadans {

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
