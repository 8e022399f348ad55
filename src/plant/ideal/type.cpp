#include "kadans/plant/ideal_world.h"
#include "kadans/plant/plant_type.h"

namespace kadans {
namespace {

class IdealType final : public PlantType {
 public:
  std::string_view name() const noexcept override { return "ideal"; }
  std::string_view doc() const noexcept override { return "joints that obey at once, on a base that stands still"; }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<World> make_world(const WorldSite& site) const override {
    return std::make_unique<IdealWorld>(site.model, site.settings, site.seed);
  }
};

}  // namespace

std::unique_ptr<PlantType> make_ideal_type() { return std::make_unique<IdealType>(); }

}  // namespace kadans
