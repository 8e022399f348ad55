// What simulated cameras have in common, whatever they look for: they take pictures at a rate, see a part of the world,
// and what a picture says arrives after a latency, with the time of the picture.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "config/scenario/scenario_config.h"
#include "kadans/model/kinematics.h"

namespace kadans {

// Where a thing is on the ground, as the robot sees it.
struct SightLine {
  double far_m = 0, bearing_rad = 0;  // from where the base points
  double yaw_rad = 0;                 // of the base

  SightLine(const Vec3& thing_m, const Pose& base) noexcept : yaw_rad(roll_pitch_yaw(base.orientation)[2]) {
    const double x_m = thing_m[0] - base.position_m[0], y_m = thing_m[1] - base.position_m[1];
    far_m = std::hypot(x_m, y_m);
    bearing_rad = std::remainder(std::atan2(y_m, x_m) - yaw_rad, 2 * std::numbers::pi);
  }
  bool in_view(const SightSettings& settings) const noexcept {
    return far_m <= settings.far_m && std::abs(bearing_rad) <= settings.view_rad / 2;
  }
};

// What pictures say, as `Seen`, which has their time_ns.
template <typename Seen>
class Pictures {
 public:
  // To be called each tick: take() when a picture is due, and arrive(seen) for what has arrived.
  template <typename Take, typename Arrive>
  void step(const SightSettings& settings, std::int64_t time_ns, Take take, Arrive arrive) noexcept {
    if (time_ns >= due_ns_) {
      due_ns_ = time_ns + std::llround(1e9 / settings.rate_Hz);
      take();
    }
    const std::int64_t latency_ns = std::llround(1e9 * settings.latency_s);
    for (; count_ > 0 && under_way_[first_].time_ns + latency_ns <= time_ns; --count_) {
      arrive(under_way_[first_]);
      first_ = (first_ + 1) % under_way_max;
    }
  }
  // What finds no place is lost.
  void send(const Seen& seen) noexcept {
    if (count_ < under_way_max) under_way_[(first_ + count_++) % under_way_max] = seen;
  }

 private:
  static constexpr std::size_t under_way_max = 128;  // that have not arrived

  std::int64_t due_ns_ = 0;
  std::array<Seen, under_way_max> under_way_{};  // a ring
  std::size_t first_ = 0, count_ = 0;
};

}  // namespace kadans
