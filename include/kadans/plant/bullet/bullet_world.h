// The robot as a Bullet multibody on a plane. Each plant has a new world of its own, so that a run repeats bit for bit.
#pragma once

#include <cstdint>
#include <memory>

#include "kadans/plant/settings.h"
#include "kadans/plant/world.h"

namespace kadans {
namespace bullet {
enum class FrictionLaw : std::uint8_t;  // src/plant/bullet/solver/contact_row.h
}

class BulletWorld final : public OneRobotWorld {
 public:
  // `seed` feeds every noise. Throws std::invalid_argument that names the setting that does not fit the model.
  BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed);
  // With another law than the cone for the plant's own solver: how a test compares it with Bullet's.
  BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed, bullet::FrictionLaw friction);
  ~BulletWorld() override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void step(std::int64_t dt_ns) override;
  const PlantTruth& truth() const noexcept override;
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override;
  void hash(StateHash& hash) const noexcept override;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace kadans
