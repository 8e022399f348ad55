// How the numbers of a walk go over to a robot of another size: by Froude similarity (Alexander and Jayes 1983, Journal
// of Zoology 201). Gravity is the same for both. So a length goes with the legs' length L, a time and a velocity with
// its root, a force with the mass M, and what has other units by what these are made of.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "kadans/control/control_object.h"

namespace kadans {

struct Similarity {
  double length = 1, mass = 1;  // of a robot, by those of the one that the numbers were found on

  // By how much a number in this unit is larger. Units without kilogram, metre and second are the same for all.
  double of(std::string_view unit) const noexcept {
    const double time = std::sqrt(length);
    if (unit == "m") return length;
    if (unit == "s" || unit == "m/s") return time;
    if (unit == "1/s") return 1 / time;
    if (unit == "m2/s2") return length;
    if (unit == "N") return mass;
    if (unit == "N/m") return mass / length;
    if (unit == "N s/m") return mass / time;
    if (unit == "Nm/rad") return mass * length;
    if (unit == "Nms/rad" || unit == "Nm s/rad") return mass * length * time;
    return 1;
  }
};

// Declares parameters whose defaults were found on a robot of another size.
class FittedDeclaration {
 public:
  FittedDeclaration(Declaration& declaration, const Similarity& similarity) noexcept
      : declaration_(&declaration), similarity_(similarity) {}

  // `value` is the default of the other robot, and becomes this one's. The range is as it is said.
  void tunable(const std::string& name, const std::string& unit, double min, double max, double& value,
               const std::string& doc) const {
    const double fitted = std::clamp(value * similarity_.of(unit), min, max);
    declaration_->parameter({name, unit, min, max, fitted, doc}, &value);
  }
  // `value` is this robot's already.
  void own(const std::string& name, const std::string& unit, double min, double max, double& value,
           const std::string& doc) const {
    declaration_->tunable(name, unit, min, max, value, doc);
  }

 private:
  Declaration* declaration_;
  Similarity similarity_;
};

}  // namespace kadans
