// Looks at one joint's readings while it is pushed: how fast it moves by its own times, and whether it still tells
// anything. One owner, one thread; nothing allocates or throws.
#pragma once

#include <cmath>
#include <cstdint>

#include "kadans/signal/frames.h"

namespace kadans {

class PushedJoint {
 public:
  void look(const JointSample& joint, std::int64_t frame_ns) noexcept {
    const std::int64_t time_ns = joint.time_ns != 0 ? joint.time_ns : frame_ns;
    if (joint.sequence == sequence_) {
      ++silent_ticks_;
      return;
    }
    silent_ticks_ = 0;
    const double dt_s = seconds_between(last_ns_, time_ns);
    if (started_ && dt_s > 0)
      velocity_rad_s_ += smoothing * ((joint.position_rad - last_rad_) / dt_s - velocity_rad_s_);
    started_ = true;
    sequence_ = joint.sequence;
    last_ns_ = time_ns;
    last_rad_ = joint.position_rad;
  }
  double velocity_rad_s() const noexcept { return velocity_rad_s_; }
  bool silent() const noexcept { return silent_ticks_ > silent_ticks_max; }

 private:
  static constexpr double smoothing = 0.1;
  static constexpr int silent_ticks_max = 100;

  int silent_ticks_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint32_t sequence_ = 0;
  bool started_ = false;
  double last_rad_ = 0, velocity_rad_s_ = 0;
};

}  // namespace kadans
