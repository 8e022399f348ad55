// Robots as Bullet multibodies on a plane. Nothing is shared between worlds, so that a run repeats bit for bit. Robots
// touch each other and the objects. A robot that touches nothing that another one touches moves bit for bit as it would
// without the other (robot_contacts.h). As a plant, the world is its first robot.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kadans/plant/settings.h"
#include "kadans/plant/world.h"

namespace kadans {
namespace bullet {
enum class FrictionLaw : std::uint8_t;  // src/plant/bullet/solver/contact_row.h
}

// Pairs of links that touch: while all joints are at 0, which lets them pass through each other in any pose, or beside
// these where the robot starts. Neighbours, and those of settings.passing, are not among them. Throws as BulletWorld
// does.
enum class TouchingAt : std::uint8_t { zero, start };
std::vector<std::pair<std::string, std::string>> touching_links(const RobotModel& model, const PlantSettings& settings,
                                                                TouchingAt at);

class BulletWorld final : public World, public WorldRobot {
 public:
  // `seed` feeds every noise. Throws std::invalid_argument that names the setting that does not fit the model.
  BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed);
  // With another law than the cone for the plant's own solver: how a test compares it with Bullet's.
  BulletWorld(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed, bullet::FrictionLaw friction);
  // Several robots, each at settings.base; at least one. The first robot's settings are those of the world: objects,
  // ground, gravity and solver iterations; payloads are each robot's own. Throws std::invalid_argument.
  explicit BulletWorld(std::span<const WorldSite> robots);
  ~BulletWorld() override;

  std::size_t robot_count() const noexcept override;
  WorldRobot& robot(std::size_t number) noexcept override;
  void step(std::int64_t dt_ns) override;
  void put(std::size_t object, const Vec3& position_m) override;
  void hash(StateHash& hash) const noexcept override;

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void write_drives(const ActuationFrame& drives) noexcept override;
  const PlantTruth& truth() const noexcept override;
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override;
  void carry(double x_m, double y_m, double heading_rad) override;

 private:
  class Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace kadans
