#include "kadans/signal/parameter.h"

#include <array>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace kadans {
namespace {

// As few digits as name the number exactly: 1e-09, not 0.000000.
std::string shortest(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace

ParameterId ParameterTable::add(Parameter parameter, double* value, std::uint32_t owner) {
  if (!(parameter.min <= parameter.max)) throw std::invalid_argument("parameter " + parameter.name + ": empty range");
  if (!(std::isfinite(parameter.initial) && parameter.initial >= parameter.min && parameter.initial <= parameter.max)) {
    throw std::invalid_argument("parameter " + parameter.name + ": initial value " + shortest(parameter.initial) +
                                " is outside " + shortest(parameter.min) + ".." + shortest(parameter.max));
  }
  const auto id = static_cast<ParameterId>(entries_.size());
  if (!ids_.emplace(parameter.name, id).second) {
    throw std::invalid_argument("parameter " + parameter.name + " is declared twice");
  }
  *value = parameter.initial;
  const OneWriter<double> newest(parameter.initial);
  entries_.push_back({std::move(parameter), value, owner, newest});
  return id;
}

bool ParameterTable::set(ParameterId id, double value) noexcept {
  if (!accepts(id, value)) return false;
  *entries_[id].value = value;
  entries_[id].newest.set(value);
  return true;
}

std::optional<ParameterId> ParameterTable::find(std::string_view name) const {
  const auto found = ids_.find(std::string(name));
  if (found == ids_.end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> ParameterTable::names() const {
  std::vector<std::string> all;
  all.reserve(entries_.size());
  for (const Entry& entry : entries_) all.push_back(entry.info.name);
  return all;
}

}  // namespace kadans
