#include "kadans/plant/plant_type.h"

#include <algorithm>
#include <stdexcept>

namespace kadans {
namespace {

[[noreturn]] void fail(const PlantType& type, const char* what) {
  throw std::logic_error("a plant of type " + std::string(type.name()) + what);
}

}  // namespace

std::unique_ptr<World> PlantType::make_world(const WorldSite&) const { fail(*this, " is no model"); }
std::unique_ptr<Plant> PlantType::make_plant(const PlantSite&) const { fail(*this, " is part of a world"); }
std::unique_ptr<PlantEmulator> PlantType::make_emulator(const PlantSite&, const std::string&) const {
  fail(*this, " speaks no protocol");
}

const PlantType& plant_type(const PlantTypes& types, std::string_view name) {
  const auto found = std::ranges::find(types, name, [](const auto& type) { return type->name(); });
  if (found == types.end()) throw std::out_of_range("no plant of type " + std::string(name));
  return **found;
}

}  // namespace kadans
