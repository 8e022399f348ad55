// Moves one joint at a low torque for as long as somebody says so, and lets it go as soon as nobody does.
//
// The torque falls with the joint's speed, to none at the greatest one, and there is none towards an end stop that is
// near. All other joints are off. One owner, one thread; nothing allocates or throws.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "kadans/signal/frames.h"
#include "pushed_joint.h"

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
  enum class Stop : std::uint8_t { none, drive, too_fast };

  explicit Jog(const Settings& settings) noexcept : settings_(settings) {}

  // A key: +1 or -1 for its directions, 0 for any other, which lets go.
  void key(int direction, std::int64_t now_ns) noexcept {
    direction_ = direction;
    until_ns_ = direction == 0 ? now_ns : now_ns + settings_.hold_ns;
  }
  // Each tick. `now_ns` is the clock of the keys.
  void step(const SensorFrame& sensors, std::int64_t now_ns, ActuationFrame& actuation) noexcept {
    const JointSample& joint = sensors.joints[settings_.joint];
    watch_.look(joint, sensors.time_ns);
    const double velocity_rad_s = watch_.velocity_rad_s();
    for (std::size_t i = 0; i < sensors.joint_count; ++i) actuation.joints[i] = {};
    actuation.joint_count = sensors.joint_count;
    if (now_ns >= until_ns_) direction_ = 0;
    if (watch_.stopped() != PushedJoint::Stop::none) stop_ = Stop::drive;
    if (std::abs(velocity_rad_s) > runaway * settings_.velocity_max_rad_s) stop_ = Stop::too_fast;
    if (sensors.emergency) direction_ = 0;
    if (stop_ != Stop::none || direction_ == 0) return;
    const double beyond =
        direction_ > 0 ? joint.position_rad - settings_.upper_rad : settings_.lower_rad - joint.position_rad;
    const double share = std::clamp(1 - direction_ * velocity_rad_s / settings_.velocity_max_rad_s, -1.0, 1.0);
    const double effort_Nm = beyond < 0 ? direction_ * share * settings_.torque_Nm : 0;
    actuation.joints[settings_.joint] = {.effort_Nm = std::isfinite(effort_Nm) ? effort_Nm : 0,
                                         .mode = ActuationMode::effort};
  }
  Stop stopped() const noexcept { return stop_; }
  PushedJoint::Stop drive_stopped() const noexcept { return watch_.stopped(); }
  bool pushes() const noexcept { return direction_ != 0 && stop_ == Stop::none; }

 private:
  static constexpr double runaway = 4;

  Settings settings_;
  PushedJoint watch_;
  int direction_ = 0;
  std::int64_t until_ns_ = 0;
  Stop stop_ = Stop::none;
};

}  // namespace kadans
