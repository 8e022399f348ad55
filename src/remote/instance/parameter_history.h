// The history of parameter changes from outside: the steps for undo, and the changes that are not yet saved in the
// configuration.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "remote/order/order.h"

namespace kadans {

class ParameterHistory {
 public:
  static constexpr std::size_t steps_max = 1000;

  // Notes that a parameter was set. `lasting`: the parameter has a place in the configuration.
  void note(const ParameterChange& change, bool lasting);
  // The newest step; nullptr when there is none. It stays until drop().
  const ParameterChange* newest() const noexcept { return steps_.empty() ? nullptr : &steps_.back(); }
  // Removes the newest step after it was undone.
  void drop();
  // Notes that these values are now saved in the configuration.
  void saved(const std::vector<ParameterChange>& changes);
  // The differences from the configuration, sorted by name.
  std::vector<ParameterChange> unsaved() const;
  // The differences from the values at the start, saved or not, sorted by name.
  std::vector<ParameterChange> set() const;

 private:
  void move_on(const ParameterChange& change);

  std::vector<ParameterChange> steps_;
  std::vector<bool> lasting_;
  std::map<std::string, ParameterChange> unsaved_, set_;
};

}  // namespace kadans
