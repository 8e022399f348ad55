#include "kadans/signal/setpoint.h"

#include <stdexcept>
#include <utility>

namespace kadans {

SetpointId SetpointTable::add(Setpoint setpoint) {
  if (!(setpoint.min <= setpoint.max)) throw std::invalid_argument("set-point " + setpoint.name + ": empty range");
  const auto id = static_cast<SetpointId>(entries_.size());
  if (!ids_.emplace(setpoint.name, id).second) {
    throw std::invalid_argument("set-point " + setpoint.name + " is declared twice");
  }
  entries_.push_back(std::move(setpoint));
  return id;
}

std::optional<SetpointId> SetpointTable::find(std::string_view name) const {
  const auto found = ids_.find(std::string(name));
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> SetpointTable::names() const {
  std::vector<std::string> all;
  all.reserve(entries_.size());
  for (const Setpoint& setpoint : entries_) all.push_back(setpoint.name);
  return all;
}

}  // namespace kadans
