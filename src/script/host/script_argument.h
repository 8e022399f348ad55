// An argument of a behavior or a skill, as k.args declares it (chart_arguments.h).
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "config/scenario/play_item.h"

namespace kadans {

struct ScriptArgument {
  std::string name, unit{}, doc{};
  std::optional<PlayValue>
      initial{};  // the default, which tells the type; nullopt: a table, which only k.call can give
  double min = -HUGE_VAL, max = HUGE_VAL;  // of a number
  std::vector<std::string> one_of{};       // of a text; empty: any
};

}  // namespace kadans
