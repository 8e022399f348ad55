// The distribution of a quantity that differs from run to run, as a configuration writes it.
//
//   { "uniform": [0.5, 1.0] }   { "normal": [1.0, 0.05] }   { "log_uniform": [0.1, 10] }   { "values": [0, 1, 2] }
//
// A value is the distribution's quantile at a number u in [0, 1). So random draws, Latin hypercubes and grids all use
// the same function.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "config/json/fields.h"

namespace kadans {

struct Distribution {
  enum class Kind : std::uint8_t { uniform, log_uniform, normal, values };
  Kind kind = Kind::uniform;
  std::array<double, 2> of{};  // low and high; for normal: mean and standard deviation
  std::vector<double> values;  // each as likely as the others
  bool together = false;       // all quantities that the pattern chooses get the same value; else each gets its own

  // The quantile at u in [0, 1). A normal distribution is cut off at four standard deviations.
  double at(double u) const noexcept;
};

// The standard normal quantile, p in (0, 1) (Wichura, 1988, algorithm AS 241, PPND7; about seven digits).
double normal_quantile(double p) noexcept;

void distribution_fields(Fields& f, Distribution& distribution);

// Quantities of a robot, chosen by a pattern over their names, and their distribution.
struct Variation {
  PlacedName pattern;  // "joint.*.torque_scale"
  Distribution distribution;
};

// The members of "randomise": the keys are the patterns.
void variation_fields(Fields& f, std::string_view name, std::vector<Variation>& variations);

}  // namespace kadans
