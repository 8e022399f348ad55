// What somebody changed from outside: the way back, step by step, and what the configuration does not say yet.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kadans/remote/order.h"

namespace kadans {

class TuningHistory {
 public:
  static constexpr std::size_t steps_max = 1000;

  // A parameter was set. `lasting`: it has a place in the configuration.
  void note(const ParameterChange& change, bool lasting);
  // The newest step, as it was made; nullptr when there is none. It stays until drop().
  const ParameterChange* newest() const noexcept { return steps_.empty() ? nullptr : &steps_.back(); }
  // The newest step was taken back.
  void drop();
  // These values stand in the configuration now.
  void saved(const std::vector<ParameterChange>& changes);
  // Against the configuration, by name.
  std::vector<ParameterChange> unsaved() const;
  // What was set since the start and is not as it was then, saved or not, by name.
  std::vector<ParameterChange> set() const;

 private:
  void move_on(const ParameterChange& change);

  std::vector<ParameterChange> steps_;
  std::vector<bool> lasting_;
  std::map<std::string, ParameterChange> unsaved_, set_;
};

}  // namespace kadans
