// A metric: a number that judges a run, beyond passed and failed, such as the greatest value of a signal or the time at
// which a condition became true.
//
//   "tilt_max_rad": { "kind": "max", "signal": "plant.base.tilt_rad", "from_s": 1 }
//   "up_s":         { "kind": "since", "that": "plant.base.height_m > 0.75" }
//   "tries":        { "kind": "end", "signal": "behavior.get_up.tries" }
//   "first_try":    { "kind": "end", "that": "behavior.get_up.tries == 1" }
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/json/fields.h"

namespace kadans {

enum class MetricKind : std::uint8_t {
  max,
  min,
  mean,
  rms,
  end,         // of a signal the last value; of a condition 1 when it holds at the end, else 0
  share,       // of the time in which the condition holds
  first_time,  // time in seconds at which the condition first held; no value when it never did
  since,       // time in seconds from which the condition held until the end; no value when it does not hold at the end
};

struct MetricConfig {
  std::string name;
  TextPlace place;
  MetricKind kind = MetricKind::max;
  std::string signal, that;  // exactly one of them is given
  TextPlace signal_place, that_place;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
};

// The members of "metrics": the keys are the names.
void metrics_fields(Fields& f, std::vector<MetricConfig>& metrics, Problems& problems);

// The whole definition in one line: two metrics with the same line are the same.
std::string definition(const MetricConfig& metric);

}  // namespace kadans
