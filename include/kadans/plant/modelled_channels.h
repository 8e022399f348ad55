// A model of the sensors that a robot's configuration names beside joints, IMU and feet. Each reads its configured
// value with noise, anew after each period. They are no part of a model's physics: scenarios set what else they read.
#pragma once

#include <cstdint>
#include <vector>

#include "kadans/signal/frames.h"
#include "kadans/signal/random.h"
#include "kadans/signal/sensor_channel.h"

namespace kadans {

class ModelledChannels {
 public:
  // Each noise comes from a stream of its own.
  ModelledChannels(const std::vector<SensorChannel>& channels, std::uint64_t seed);

  // Between ticks.
  void sample(std::int64_t time_ns);
  void fill(SensorFrame& frame) const noexcept;

 private:
  struct Channel {
    double value, noise;
    std::int64_t period_ns;
    RandomStream stream;
    std::int64_t due_ns = 0;
    ChannelSample sample{};
  };
  std::vector<Channel> channels_;
};

}  // namespace kadans
