// Perception in a simulation: what a camera with its program would say of the ball, from the truth of the world.
//
// It takes pictures at a rate. In a picture the ball is where it truly is, but for noise: of the distance, in
// proportion to it, and of the bearing. Some pictures miss the ball, and the ball is not seen outside of the field of
// view. What a picture says arrives after a latency, with the time of the picture. All random numbers come from one
// stream of the run's seed.
#pragma once

#include <cstddef>
#include <cstdint>

#include "config/scenario/scenario_config.h"
#include "kadans/plant/world.h"
#include "kadans/signal/random.h"
#include "kadans/signal/sight.h"
#include "pictures.h"

namespace kadans {

class SimulatedSight {
 public:
  // `ball` is the object's place in the world.
  SimulatedSight(const SightSettings& settings, std::size_t ball, std::uint64_t seed);

  // To be called each tick. What has arrived by now.
  const SeenBall& at(std::int64_t time_ns, const PlantTruth& truth) noexcept;

 private:
  void look(std::int64_t time_ns, const PlantTruth& truth) noexcept;

  SightSettings settings_;
  std::size_t ball_;
  RandomStream random_;
  Pictures<SeenBall> pictures_;
  SeenBall arrived_;
};

}  // namespace kadans
