#include "simulated_sight.h"

#include <algorithm>
#include <cmath>

#include "kadans/model/kinematics.h"

namespace kadans {

SimulatedSight::SimulatedSight(const SightSettings& settings, std::size_t ball, std::uint64_t seed)
    : settings_(settings), ball_(ball), random_(seed, "sight/ball") {}

void SimulatedSight::look(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  // Always as many numbers, so that nothing that is missed shifts what follows.
  const bool missed = random_.uniform() < settings_.missed;
  const double distance_off = settings_.distance_noise * random_.normal();
  const double bearing_off_rad = settings_.bearing_noise_rad * random_.normal();
  const Vec3 &ball_m = truth.objects[ball_].pose.position_m, &base_m = truth.base.position_m;
  const double x_m = ball_m[0] - base_m[0], y_m = ball_m[1] - base_m[1];
  const double far_m = std::hypot(x_m, y_m), yaw_rad = roll_pitch_yaw(truth.base.orientation)[2];
  const double bearing_rad = std::remainder(std::atan2(y_m, x_m) - yaw_rad, 2 * M_PI);
  if (missed || far_m > settings_.far_m || std::abs(bearing_rad) > settings_.view_rad / 2 || count_ == under_way_max)
    return;
  const double seen_m = far_m * (1 + distance_off), seen_rad = bearing_rad + bearing_off_rad;
  under_way_[(first_ + count_++) % under_way_max] = {.time_ns = time_ns,
                                                     .x_m = seen_m * std::cos(seen_rad),
                                                     .y_m = seen_m * std::sin(seen_rad),
                                                     .confidence = 1 - 0.5 * far_m / settings_.far_m};
}

const SeenBall& SimulatedSight::at(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  if (time_ns >= due_ns_) {
    due_ns_ = time_ns + std::llround(1e9 / settings_.rate_Hz);
    look(time_ns, truth);
  }
  const std::int64_t latency_ns = std::llround(1e9 * settings_.latency_s);
  for (; count_ > 0 && under_way_[first_].time_ns + latency_ns <= time_ns; --count_) {
    arrived_ = under_way_[first_];
    first_ = (first_ + 1) % under_way_max;
  }
  return arrived_;
}

}  // namespace kadans
