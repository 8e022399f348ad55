// A robot light enough for ten thousand runs: four joints, two feet and an IMU with noise, without physics to speak of.
// Its joints differ in their limits: the second may change its torque slowly only, the third has little power.
#pragma once

#include <memory>
#include <vector>

#include "kadans/plant/ideal_world.h"
#include "kadans/signal/random.h"
#include "rig.h"

namespace kadans::failures {

inline constexpr std::size_t joints = 4;

// The ideal plant with feet, noise, and drives whose position and velocity modes are servos: the ideal plant's own
// would be where they are told to be at once.
class NoisyPlant final : public OneRobotWorld {
 public:
  NoisyPlant(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
      : ideal_(model, settings), random_(seed, "light robot") {}
  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void step(std::int64_t dt_ns) override { ideal_.step(dt_ns); }
  const PlantTruth& truth() const noexcept override { return ideal_.truth(); }
  void push(std::size_t, const Vec3&, const Vec3&) override {}
  void hash(StateHash& hash) const noexcept override { ideal_.hash(hash); }

 private:
  IdealWorld ideal_;
  RandomStream random_;
};

// Poses "there" and "safe".
struct LightParts {
  LightParts(std::uint64_t seed, std::vector<Transmission> transmissions);
  RobotModel light_model;
  NoisyPlant sound;
  Catalog light_catalog;
  std::vector<std::unique_ptr<ControlObject>> objects();
};

class LightRobot : private LightParts, public Rig {
 public:
  explicit LightRobot(std::uint64_t seed, const Reactions& reactions = default_reactions(),
                      std::vector<Transmission> transmissions = {});
};

}  // namespace kadans::failures
