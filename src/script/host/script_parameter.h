// A tunable parameter of a behavior, declared in k.params. It has a range and can be changed while the behavior runs.
#pragma once

#include <string>

namespace kadans {

struct ScriptParameter {
  std::string chunk;  // the file that declares it
  std::string name;
  std::string unit;
  std::string doc;
  double initial = 0, min = 0, max = 0;
  double value = 0;
  double loaded = 0;  // its value when the behavior was loaded, with its arguments and those of robot.json
};

}  // namespace kadans
