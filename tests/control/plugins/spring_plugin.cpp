// A good plug-in, made as everybody would: a control object and a type of plant.
#include "kadans/control/plugin.h"
#include "kadans/plant/ideal_world.h"
#include "spring.h"

namespace {

// An ideal model with a setting of its own.
class FloatingType final : public kadans::PlantType {
 public:
  std::string_view name() const noexcept override { return "floating"; }
  std::string_view doc() const noexcept override { return "an ideal model, so high above the ground"; }
  bool has_fields() const noexcept override { return true; }
  void fields(kadans::PlantFields& f) override { f.number("height_m", height_m_, {0, 10, "m"}, "of the base"); }
  bool is_model() const noexcept override { return true; }
  std::unique_ptr<kadans::World> make_world(const kadans::WorldSite& site) const override {
    kadans::PlantSettings settings = site.settings;
    settings.base.position_m[2] = height_m_;
    return std::make_unique<kadans::IdealWorld>(site.model, settings, site.seed);
  }

 private:
  double height_m_ = 1;
};

std::unique_ptr<kadans::PlantType> make_floating_type() { return std::make_unique<FloatingType>(); }

}  // namespace

KADANS_PLUGIN(kadans::plugin_type<make_spring>("spring"), kadans::plugin_type<make_floating_type>())
