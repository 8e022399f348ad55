// The electronics of modelled drives: their states, the orders that they take, their brakes. What an enabled drive
// makes of its actuation is the model's own matter.
//
// Homing takes no time, since a model's encoders are absolute.
//
// One owner at a time: write() and fill() in the tick, step() between ticks; nothing allocates after the construction.
#pragma once

#include <cstdint>
#include <vector>

#include "kadans/plant/settings.h"
#include "kadans/signal/frames.h"
#include "kadans/signal/random.h"
#include "kadans/signal/sensor_channel.h"
#include "kadans/signal/state_hash.h"

namespace kadans {

class ModelledDrives {
 public:
  // One a joint; joints without settings have a drive that is enabled.
  ModelledDrives(const std::vector<DriveSettings>& settings, std::size_t joints);

  // Carries out the orders that are new.
  void write(const ActuationFrame& actuation) noexcept;
  void step(std::int64_t dt_ns) noexcept;
  void fill(SensorFrame& frame) const noexcept;

  bool enabled(std::size_t joint) const noexcept { return drives_[joint].state == DriveState::enabled; }
  bool braked(std::size_t joint) const noexcept { return drives_[joint].braked(); }
  // Adds nothing while all are enabled and no brake holds.
  void hash(StateHash& hash) const noexcept;

 private:
  enum class Brake : std::uint8_t { by_itself, closed, open };  // the last two by hand
  struct Drive {
    std::int64_t enable_ns = 0, waits_ns = 0;  // what enabling takes, and what is left of it; 0: nobody asked
    DriveState state = DriveState::enabled;
    Brake brake = Brake::by_itself;
    std::uint8_t order_seen = 0;
    bool has_brake = false;
    bool lets_go = true;  // its newest mode is off

    void carry_out(DriveOrder order) noexcept;
    bool braked() const noexcept {
      const bool holds = state == DriveState::enabled && !lets_go;
      return has_brake && (brake == Brake::closed || (brake == Brake::by_itself && !holds));
    }
  };
  std::vector<Drive> drives_;
};

// A model of the sensors that a robot's configuration names beside joints, IMU and feet. Each reads its configured
// value with noise, anew after each period. They are no part of a model's physics: scenarios set what else they read.
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
