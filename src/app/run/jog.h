// Moves one joint at a low torque for as long as somebody says so, and lets it go as soon as nobody does.
//
// The torque falls with the joint's speed, to none at the greatest one, and there is none towards an end stop that is
// near. All other joints are off. One owner, one thread; nothing allocates or throws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kadans/signal/frames.h"

namespace kadans {

class Jog {
 public:
  struct Settings {
    std::size_t joint = 0;
    double torque_Nm = 0;                 // > 0
    double velocity_max_rad_s = 0.5;      // at which no torque is left
    double lower_rad = 0, upper_rad = 0;  // no torque beyond them
    std::int64_t hold_ns = 150'000'000;   // how long a key counts: terminals repeat those that are held
  };
  enum class Stop : std::uint8_t { none, fault, silent, too_fast };

  explicit Jog(const Settings& settings) noexcept : settings_(settings) {}

  // A key: +1 or -1 for its directions, 0 for any other, which lets go.
  void key(int direction, std::int64_t now_ns) noexcept {
    direction_ = direction;
    until_ns_ = direction == 0 ? now_ns : now_ns + settings_.hold_ns;
  }
  // Each tick. `now_ns` is the clock of the keys.
  void step(const SensorFrame& sensors, std::int64_t now_ns, ActuationFrame& actuation) noexcept {
    const JointSample& joint = sensors.joints[settings_.joint];
    look(joint, sensors.time_ns);
    for (std::size_t i = 0; i < sensors.joint_count; ++i) actuation.joints[i] = {};
    actuation.joint_count = sensors.joint_count;
    if (now_ns >= until_ns_) direction_ = 0;
    if (joint.drive == DriveState::fault) stop_ = Stop::fault;
    if (silent_ticks_ > silent_ticks_max) stop_ = Stop::silent;
    if (std::abs(velocity_rad_s_) > runaway * settings_.velocity_max_rad_s) stop_ = Stop::too_fast;
    if (sensors.emergency) direction_ = 0;
    if (stop_ != Stop::none || direction_ == 0) return;
    const double beyond =
        direction_ > 0 ? joint.position_rad - settings_.upper_rad : settings_.lower_rad - joint.position_rad;
    const double share = std::clamp(1 - direction_ * velocity_rad_s_ / settings_.velocity_max_rad_s, -1.0, 1.0);
    const double effort_Nm = beyond < 0 ? direction_ * share * settings_.torque_Nm : 0;
    actuation.joints[settings_.joint] = {.effort_Nm = std::isfinite(effort_Nm) ? effort_Nm : 0,
                                         .mode = ActuationMode::effort};
  }
  Stop stopped() const noexcept { return stop_; }
  bool pushes() const noexcept { return direction_ != 0 && stop_ == Stop::none; }

 private:
  static constexpr double smoothing = 0.1, runaway = 4;
  static constexpr int silent_ticks_max = 100;

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

  Settings settings_;
  int direction_ = 0, silent_ticks_ = 0;
  std::int64_t until_ns_ = 0, last_ns_ = 0;
  std::uint32_t sequence_ = 0;
  bool started_ = false;
  double last_rad_ = 0, velocity_rad_s_ = 0;
  Stop stop_ = Stop::none;
};

}  // namespace kadans
