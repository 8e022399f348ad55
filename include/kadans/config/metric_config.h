// A number that a run is judged by, beyond passed and failed: how high a signal rose, when a condition came true.
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

#include "kadans/config/fields.h"

namespace kadans {

enum class MetricKind : std::uint8_t {
  max,
  min,
  mean,
  rms,
  end,         // of a signal its last value; of a condition 1 when it holds then, else 0
  share,       // of the time in which the condition holds
  first_time,  // in seconds, when the condition first held; nothing when it never did
  since,       // in seconds, from when on the condition held up to the end; nothing when it does not at the end
};

struct MetricConfig {
  std::string name;
  TextPlace place;
  MetricKind kind = MetricKind::max;
  std::string signal, that;  // one of them
  TextPlace signal_place, that_place;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
};

// The members of "metrics": the keys are the names.
void metrics_fields(Fields& f, std::vector<MetricConfig>& metrics, Problems& problems);

// One line that says all of it: two metrics with the same line are the same.
std::string definition(const MetricConfig& metric);

}  // namespace kadans
