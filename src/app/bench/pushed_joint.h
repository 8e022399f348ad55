// Looks at one joint's readings while it is pushed: how fast it moves by its own times, and whether it still tells
// anything. One owner, one thread; nothing allocates or throws.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "kadans/signal/fault.h"
#include "kadans/signal/frames.h"

namespace kadans {

class PushedJoint {
 public:
  void look(const JointSample& joint, std::int64_t frame_ns) noexcept {
    const std::int64_t time_ns = joint.time_ns != 0 ? joint.time_ns : frame_ns;
    since_s_ = 0;
    fault_ = joint.drive == DriveState::fault;
    if (joint.sequence == sequence_) {
      ++silent_ticks_;
      return;
    }
    silent_ticks_ = 0;
    if (started_) since_s_ = std::max(0.0, seconds_between(last_ns_, time_ns));
    if (since_s_ > 0) velocity_rad_s_ += smoothing * ((joint.position_rad - last_rad_) / since_s_ - velocity_rad_s_);
    started_ = true;
    sequence_ = joint.sequence;
    last_ns_ = time_ns;
    last_rad_ = joint.position_rad;
  }
  double velocity_rad_s() const noexcept { return velocity_rad_s_; }
  double since_s() const noexcept { return since_s_; }  // from the reading before to this one; 0: it is not new
  enum class Stop : std::uint8_t { none, fault, silent };
  Stop stopped() const noexcept {
    return silent_ticks_ > silent_ticks_max ? Stop::silent : fault_ ? Stop::fault : Stop::none;
  }

 private:
  static constexpr double smoothing = 0.1;
  static constexpr int silent_ticks_max = 100;

  int silent_ticks_ = 0;
  std::int64_t last_ns_ = 0;
  std::uint32_t sequence_ = 0;
  bool started_ = false, fault_ = false;
  double last_rad_ = 0, velocity_rad_s_ = 0, since_s_ = 0;
};

// Why a drive stopped, behind its name.
inline std::string stop_words(PushedJoint::Stop stop, std::uint32_t code, DriveWords words) {
  if (stop != PushedJoint::Stop::fault) return "tells nothing any more";
  return "has a fault, code " + std::to_string(code) + (words == nullptr ? "" : ": " + std::string(words(code)));
}

}  // namespace kadans
