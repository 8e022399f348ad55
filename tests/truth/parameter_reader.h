// Takes an engine's parameters out of those that were given, and refuses what is left over.
#pragma once

#include <stdexcept>

#include "cube.h"

namespace kadans::truth {

class ParameterReader {
 public:
  explicit ParameterReader(const Parameters& given) : left_(given) {}

  ParameterReader& take(const std::string& name, double& value) {
    const auto found = left_.find(name);
    if (found == left_.end()) return *this;
    value = found->second;
    left_.erase(found);
    return *this;
  }
  void end() const {
    if (!left_.empty()) throw std::invalid_argument("there is no parameter " + left_.begin()->first);
  }

 private:
  Parameters left_;
};

}  // namespace kadans::truth
