#include "kadans/control/control_object_types.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

RegisteredControlObject* newest_registered = nullptr;  // constant-initialised: there before any constructor runs

}  // namespace

RegisteredControlObject::RegisteredControlObject(const char* name, Make make) noexcept
    : name_(name), make_(make), next_(std::exchange(newest_registered, this)) {}

void ControlObjectTypes::add(const std::string& name, MakeControlObject make, const std::string& source) {
  if (name.empty() || !make)
    throw std::invalid_argument("a type of control object needs a name and a function that makes it");
  const auto taken = std::ranges::find(types_, name, &Type::name);
  if (taken != types_.end()) {
    throw std::invalid_argument("the type of control object '" + name + "' of " + source + " is taken by " +
                                taken->source);
  }
  types_.push_back({name, std::move(make), source});
}

void ControlObjectTypes::add_registered() {
  std::vector<const RegisteredControlObject*> registered;
  for (const auto* one = newest_registered; one != nullptr; one = one->next_) registered.push_back(one);
  std::ranges::sort(registered, {}, [](const auto* one) { return std::string_view(one->name_); });  // no linker's order
  for (const auto* one : registered) add(one->name_, one->make_, "this program");
}

const MakeControlObject* ControlObjectTypes::find(std::string_view name) const noexcept {
  const auto found = std::ranges::find(types_, name, &Type::name);
  return found == types_.end() ? nullptr : &found->make;
}

std::vector<std::string> ControlObjectTypes::names() const { return names_of(types_); }

}  // namespace kadans
