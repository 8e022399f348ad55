// The parameter table: every tunable of the control layer, declared once. Names are for people, configuration and
// scripts; the tick addresses parameters by number. The value itself lives in its owner, a control object or a filter,
// where only the control thread may touch it. For all other threads the table keeps a copy of what was set last.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "kadans/exchange/one_writer.h"

namespace kadans {

using ParameterId = std::uint32_t;

struct Parameter {
  std::string name;  // "posture.l_knee.kp_Nm_per_rad": owner, part, quantity with its unit
  std::string unit;  // "" for a pure number
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double initial = 0;
  std::string doc;  // one sentence
};

class ParameterTable {
 public:
  // Before the loop. `value` is the owner's variable and is set to the initial value; it must outlive the table's use.
  // `owner` tells owners apart for the engine (the control object's index). Throws std::invalid_argument on a name that
  // is taken, an empty range, or an initial value that is outside it or not finite. A name that is refused leaves the
  // table as it was.
  ParameterId add(Parameter parameter, double* value, std::uint32_t owner = 0);

  // Any thread: whether the id is known and the value finite and within the range.
  bool accepts(ParameterId id, double value) const noexcept {
    return id < entries_.size() && std::isfinite(value) && value >= entries_[id].info.min &&
           value <= entries_[id].info.max;
  }
  // Control thread. False, and nothing changes, on an unknown id or a value that is not finite or outside
  // [min, max].
  [[nodiscard]] bool set(ParameterId id, double value) noexcept;
  // Control thread, or one that runs in lockstep with it; id < size().
  double get(ParameterId id) const noexcept { return *entries_[id].value; }
  // Any thread: what was set last; id < size(). Each number is whole, but not all are of the same tick.
  double newest(ParameterId id) const noexcept { return entries_[id].newest.get(); }
  std::uint32_t owner(ParameterId id) const noexcept { return entries_[id].owner; }

  // Any thread: the declarations do not change once the loop runs.
  std::optional<ParameterId> find(std::string_view name) const;
  // Throws std::out_of_range on an unknown id.
  const Parameter& info(ParameterId id) const { return entries_.at(id).info; }
  std::size_t size() const noexcept { return entries_.size(); }
  std::vector<std::string> names() const;

 private:
  struct Entry {
    Parameter info;
    double* value;
    std::uint32_t owner;
    OneWriter<double> newest;
  };
  std::vector<Entry> entries_;
  std::unordered_map<std::string, ParameterId> ids_;
};

}  // namespace kadans
