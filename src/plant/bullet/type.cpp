#include "kadans/plant/bullet/bullet_world.h"
#include "kadans/plant/plant_type.h"

namespace kadans {
namespace {

class BulletType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "bullet"; }
  std::string_view doc() const noexcept override { return "the robot's model in a world of bodies that collide"; }
  bool is_model() const noexcept override { return true; }
  bool has_objects() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& site) const override {
    return std::make_unique<BulletWorld>(site.model, site.settings, site.seed);
  }
  std::unique_ptr<World> make_shared_world(std::span<const WorldSite> sites) const override {
    return std::make_unique<BulletWorld>(sites);
  }
};

}  // namespace

std::unique_ptr<PlantType> make_bullet_type() { return std::make_unique<BulletType>(); }

}  // namespace kadans
