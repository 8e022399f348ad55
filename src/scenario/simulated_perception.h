// Perception of the world model's entries in a simulation: what a detector would say, from the truth of the world.
//
// It takes pictures at a rate. In a picture a thing is where it truly is, but for noise: of the distance, in proportion
// to it, and of the bearing. Some pictures miss it; some show it somewhere in the field of view where it is not; boxes
// and balls may hide it. What a picture says arrives after a latency, with the time of the picture. All random numbers
// of an entry come from one stream of the run's seed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "kadans/plant/world.h"
#include "kadans/plant/world_settings.h"
#include "kadans/signal/observation.h"
#include "kadans/signal/random.h"
#include "kadans/signal/seen_info.h"
#include "pictures.h"

namespace kadans {

class SimulatedPerception {
 public:
  // Throws InputError when the entry or the object is not there, or the entry has fields other than a place. `file`
  // names the scenario in messages.
  SimulatedPerception(const ScenarioPerception& settings, const std::vector<SeenInfo>& seen,
                      const std::vector<WorldObject>& objects, std::uint64_t seed, const std::string& file);

  // To be called each tick: takes pictures when they are due, and hands on what has arrived.
  void look(std::int64_t time_ns, const PlantTruth& truth, ObservationSink& sink) noexcept;

 private:
  struct Blocker {  // what can stand before the thing: an upright cylinder
    std::size_t object = 0;
    double radius_m = 0, half_height_m = 0;
  };

  void take_picture(std::int64_t time_ns, const PlantTruth& truth) noexcept;
  bool hidden(const PlantTruth& truth) const noexcept;
  void send(std::int64_t time_ns, double far_m, double bearing_rad, double heading_rad) noexcept;

  ScenarioPerception settings_;
  std::uint32_t entry_ = 0;
  std::size_t object_ = 0, places_ = 2;
  std::vector<Blocker> blockers_;
  RandomStream random_;
  Pictures<Observation> pictures_;
};

}  // namespace kadans
