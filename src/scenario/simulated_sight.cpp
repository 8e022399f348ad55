#include "simulated_sight.h"

#include <cmath>

namespace kadans {

SimulatedSight::SimulatedSight(const SightSettings& settings, std::size_t ball, std::uint64_t seed)
    : settings_(settings), ball_(ball), random_(seed, "sight/ball") {}

void SimulatedSight::look(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  // Always as many numbers, so that nothing that is missed shifts what follows.
  const bool missed = random_.uniform() < settings_.missed;
  const double distance_off = settings_.distance_noise * random_.normal();
  const double bearing_off_rad = settings_.bearing_noise_rad * random_.normal();
  const SightLine ball(truth.objects[ball_].pose.position_m, truth.base);
  if (missed || !ball.in_view(settings_)) return;
  const double seen_m = ball.far_m * (1 + distance_off), seen_rad = ball.bearing_rad + bearing_off_rad;
  pictures_.send({.time_ns = time_ns,
                  .x_m = seen_m * std::cos(seen_rad),
                  .y_m = seen_m * std::sin(seen_rad),
                  .confidence = 1 - 0.5 * ball.far_m / settings_.far_m});
}

const SeenBall& SimulatedSight::at(std::int64_t time_ns, const PlantTruth& truth) noexcept {
  pictures_.step(
      settings_, time_ns, [&] { look(time_ns, truth); }, [&](const SeenBall& seen) { arrived_ = seen; });
  return arrived_;
}

}  // namespace kadans
