#include "kadans/plant/plant_type.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kadans {
namespace {

RegisteredPlantType* newest_registered = nullptr;  // constant-initialised: there before any constructor runs

[[noreturn]] void fail(const PlantType& type, const char* what) {
  throw std::logic_error("a plant of type " + std::string(type.name()) + what);
}

}  // namespace

std::unique_ptr<World> PlantType::make_world(const WorldSite&) const { fail(*this, " is no model"); }
std::unique_ptr<World> PlantType::make_shared_world(std::span<const WorldSite>) const {
  fail(*this, " has a world of one robot");
}
std::unique_ptr<Plant> PlantType::make_plant(const PlantSite&) const { fail(*this, " is part of a world"); }
std::unique_ptr<PlantEmulator> PlantType::make_emulator(const PlantSite&, const std::string&) const {
  fail(*this, " speaks no protocol");
}
std::unique_ptr<World> PlantType::make_wired_world(std::unique_ptr<World>, const PlantSite&,
                                                   const std::vector<EmulatedFault>&) const {
  fail(*this, " has no wire on virtual time");
}

void PlantEmulator::plan_faults(const std::vector<EmulatedFault>& faults) {
  if (!faults.empty()) throw std::invalid_argument("this protocol has no faults: let scenarios have them");
}

RegisteredPlantType::RegisteredPlantType(MakePlantType make) noexcept
    : make_(make), next_(std::exchange(newest_registered, this)) {}

void RegisteredPlantType::add_all(PlantTypes& types, std::span<const MakePlantType> others) {
  const auto name = [](const auto& type) { return type->name(); };
  const auto shipped = static_cast<std::ptrdiff_t>(types.size());
  for (const auto* one = newest_registered; one != nullptr; one = one->next_) types.push_back(one->make_());
  std::ranges::sort(types.begin() + shipped, types.end(), {}, name);  // no linker's order
  for (const MakePlantType make : others) types.push_back(make());
  PlantTypes all = types;
  std::ranges::sort(all, {}, name);
  const auto twice = std::ranges::adjacent_find(all, {}, name);
  if (twice != all.end()) throw std::invalid_argument("two types of plants have the name " + std::string(name(*twice)));
}

const PlantType& plant_type(const PlantTypes& types, std::string_view name) {
  const auto found = std::ranges::find(types, name, [](const auto& type) { return type->name(); });
  if (found == types.end()) throw std::out_of_range("no plant of type " + std::string(name));
  return **found;
}

std::vector<std::string> plant_type_names(const PlantTypes& types, bool (PlantType::*is)() const noexcept) {
  std::vector<std::string> names;
  for (const auto& type : types) {
    if (is == nullptr || (*type.*is)()) names.emplace_back(type->name());
  }
  return names;
}

}  // namespace kadans
