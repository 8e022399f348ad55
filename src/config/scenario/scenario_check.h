// A check of a scenario: one signal must stay within bounds, or a Lua condition over several signals must hold.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "config/json/fields.h"

namespace kadans {

// "It" is the demand of the check: the signal is within [min, max], or the condition `that` is true.
enum class CheckKind : std::uint8_t {
  always,      // it holds in every tick
  never,       // it holds in no tick
  eventually,  // it holds in at least one tick
  at_end,      // it holds in the last tick
  within,      // each time that `when` becomes true, it holds at most within_s later
  settles,     // at most within_s after `when` (or from_s) it begins to hold, and holds until the end
};

struct ScenarioCheck {
  std::string name;
  CheckKind kind = CheckKind::always;
  std::string signal;  // "" with a condition
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string that;  // a condition in Lua; "" with a signal
  std::string when;  // for within and settles
  double within_s = 0;
  double from_s = 0;                                         // the check covers the time from here ...
  double until_s = std::numeric_limits<double>::infinity();  // ... to here, both included
  TextPlace signal_place, that_place, when_place;
};

// The fields of one check. When there is a file, it also verifies that the fields fit together. `others` are the checks
// before it.
void check_fields(Fields& f, ScenarioCheck& check, double duration_s, const std::vector<ScenarioCheck>& others,
                  Problems& problems);

}  // namespace kadans
