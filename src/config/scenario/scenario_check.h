// What judges a run of a scenario: its checks, and metrics.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/json/fields.h"

namespace kadans {

// A check of a scenario: one signal must stay within bounds, or a Lua condition over several signals must hold. "It" is
// the demand of the check: the signal is within [min, max], or the condition `that` is true. Behind each kind stands
// the value that is told of the check.
enum class CheckKind : std::uint8_t {
  always,      // it holds in every tick: the worst value
  never,       // it holds in no tick: the worst value
  eventually,  // it holds in at least one tick: the value nearest to or deepest in the demand
  at_end,      // it holds in the last tick: the last value
  within,      // each time that `when` becomes true, it holds at most within_s later: the last value
  settles,     // at most within_s after `when` (or from_s) it begins to hold, and holds until the end: the time in s
};
inline const std::array<std::string, 6> check_kinds{"always", "never", "eventually", "at_end", "within", "settles"};

struct ScenarioCheck {
  std::string name;
  CheckKind kind = CheckKind::always;
  std::string signal;  // "" with a condition
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string that;  // a condition in Lua; "" with a signal
  std::string when;  // a condition from which the time counts, for some kinds
  double within_s = 0;
  double from_s = 0;                                         // the check covers the time from here ...
  double until_s = std::numeric_limits<double>::infinity();  // ... to here, both included
  TextPlace signal_place, that_place, when_place;
};

// The fields of one check. When there is a file, it also verifies that the fields fit together. `others` are the checks
// before it.
void check_fields(Fields& f, ScenarioCheck& check, double duration_s, const std::vector<ScenarioCheck>& others);

// Whether the check can judge a run that ends at duration_s, before the scenario's end.
inline bool judges_run_until(const ScenarioCheck& check, double duration_s) noexcept {
  if (check.from_s >= duration_s) return false;
  switch (check.kind) {
    case CheckKind::always:
    case CheckKind::never:
    case CheckKind::within:
      return true;
    case CheckKind::eventually:
      return check.until_s <= duration_s;
    case CheckKind::at_end:
    case CheckKind::settles:
      return false;
  }
  return false;
}

// A metric: a number that judges a run, beyond passed and failed, such as the greatest value of a signal or the time at
// which a condition became true.
//
//   "tilt_max_rad": { "kind": "max", "signal": "plant.base.tilt_rad", "from_s": 1 }
//   "up_s":         { "kind": "since", "that": "plant.base.height_m > 0.75" }
//   "tries":        { "kind": "end", "signal": "behavior.get_up.tries" }
//   "first_try":    { "kind": "end", "that": "behavior.get_up.tries == 1" }
//   "far_m":        { "kind": "max", "value": "sqrt(plant.base.x_m^2 + plant.base.y_m^2)" }
enum class MetricKind : std::uint8_t {
  max,
  min,
  mean,
  rms,
  end,         // of a signal or number the last value; of a condition 1 when it holds at the end, else 0
  share,       // of the time in which the condition holds
  first_time,  // time in seconds at which the condition first held; no value when it never did
  since,       // time in seconds from which the condition held until the end; no value when it does not hold at the end
};

struct MetricConfig {
  std::string name;
  TextPlace place;
  MetricKind kind = MetricKind::max;
  std::string signal, value, that;  // exactly one of them is given: a name, a number in Lua, a condition in Lua
  TextPlace signal_place, value_place, that_place;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();
};

// The members of "metrics": the keys are the names.
void metrics_fields(Fields& f, std::vector<MetricConfig>& metrics);

// The whole definition in one line: two metrics with the same line are the same.
std::string definition(const MetricConfig& metric);

}  // namespace kadans
