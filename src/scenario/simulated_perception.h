// Perception in a simulation: what a camera with its program would say, from the truth of the world.
//
// It takes pictures at a rate. In a picture a thing is where it truly is, but for noise: of the distance, in proportion
// to it, and of the bearing. Some pictures miss it, and it is not seen outside of the field of view. What a picture
// says arrives after a latency, with the time of the picture. All random numbers of a thing come from one stream of the
// run's seed.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "kadans/model/kinematics.h"
#include "kadans/plant/world.h"
#include "kadans/plant/world_settings.h"
#include "kadans/signal/observation.h"
#include "kadans/signal/random.h"
#include "kadans/signal/seen_info.h"
#include "kadans/signal/sight.h"

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

// Of the ball.
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

// Of an entry of the world model, as a detector would see it. Some pictures show it somewhere in the field of view
// where it is not; boxes and balls may hide it.
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
