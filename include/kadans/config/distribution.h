// A quantity that differs from run to run: how its values are spread, as a configuration says it.
//
//   { "uniform": [0.5, 1.0] }   { "normal": [1.0, 0.05] }   { "log_uniform": [0.1, 10] }   { "values": [0, 1, 2] }
//
// A value is the distribution's quantile at a number u of [0, 1): so plain random draws, Latin hypercubes and grids all
// come from the same place.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/config/fields.h"

namespace kadans {

struct Distribution {
  enum class Kind : std::uint8_t { uniform, log_uniform, normal, values };
  Kind kind = Kind::uniform;
  std::array<double, 2> of{};  // low and high; of normal: mean and standard deviation
  std::vector<double> values;  // each as likely as the others
  bool together = false;       // all names that a pattern chooses get the same value, else each its own

  // The quantile. u in [0, 1); of normal cut off at four standard deviations.
  double at(double u) const noexcept;
};

// The standard normal quantile, p in (0, 1) (Wichura, 1988, algorithm AS 241, PPND7; about seven digits).
double normal_quantile(double p) noexcept;

void distribution_fields(Fields& f, Distribution& distribution, Problems& problems);

// One or more quantities of a robot, chosen by a pattern over their names, and how they vary.
struct Variation {
  PlacedName pattern;  // "joint.*.torque_scale"
  Distribution distribution;
};

// The members of "randomise": the keys are the patterns.
void variation_fields(Fields& f, std::string_view name, std::vector<Variation>& variations, Problems& problems);

}  // namespace kadans
