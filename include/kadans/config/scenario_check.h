// What a scenario demands: of one signal, that it stays within bounds; of several, a condition in Lua.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "kadans/config/fields.h"

namespace kadans {

// Each speaks of what the check demands: a signal within [min, max], or the condition `that`.
enum class CheckKind : std::uint8_t {
  always,      // it holds in every tick
  never,       // in none
  eventually,  // in at least one
  at_end,      // in the last
  within,      // whenever `when` becomes true, it holds at the latest within_s later
  settles,     // from `when` on (or from_s) it holds for good at the latest within_s later
};

struct ScenarioCheck {
  std::string name;
  CheckKind kind = CheckKind::always;
  std::string signal;  // "" with a condition
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  std::string that;  // a condition in Lua, "" with a signal
  std::string when;  // of within and settles
  double within_s = 0;
  double from_s = 0;                                         // looked at from here ...
  double until_s = std::numeric_limits<double>::infinity();  // ... to here, both included
  TextPlace signal_place, that_place, when_place;
};

// The fields of one check; with a file, what they say together is looked at as well. `others` are those before it.
void check_fields(Fields& f, ScenarioCheck& check, double duration_s, const std::vector<ScenarioCheck>& others,
                  Problems& problems);

}  // namespace kadans
