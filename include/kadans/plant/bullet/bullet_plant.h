// The robot as a Bullet multibody on a plane: one new world a plant, so that a run repeats bit for bit.
#pragma once

#include <cstdint>
#include <memory>

#include "kadans/plant/plant.h"
#include "kadans/plant/settings.h"

namespace kadans {

class BulletPlant final : public ModelPlant {
 public:
  // `seed` feeds every noise. Throws std::invalid_argument naming what in the settings does not fit the model.
  BulletPlant(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed);
  ~BulletPlant() override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void step(std::int64_t dt_ns) override;
  const PlantTruth& truth() const noexcept override;
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override;
  void hash(StateHash& hash) const noexcept override;

 private:
  class World;
  std::unique_ptr<World> world_;
};

}  // namespace kadans
