// The row of the failure contract on switching. All pairs in all situations are a benchmark, scripts/bench --only
// switch; here every object hands over to and takes over from the PID and an object in position mode.
#include <doctest/doctest.h>

#include "bench/control/switch_pairs.h"

namespace contract_switch_test {

using namespace kadans::bench;
using doctest::description;

TEST_SUITE_BEGIN("contract");

TEST_CASE("the step of a drive's torque stays below 2 % of its limit, whatever the modes" *
          description("control objects are switched, at rest, moving, under load or saturated")) {
  const double step_max = switch_step_max();
  for (const std::string& set : switch_sets()) {
    for (const char* other : {"pid", "profile"}) {
      if (set == other) continue;
      for (const Situation situation : situations) {
        for (const SwitchStep& step : {measure_switch(set, other, situation), measure_switch(other, set, situation)}) {
          CAPTURE(step.from);
          CAPTURE(step.to);
          CAPTURE(step.joint);
          CAPTURE(name(situation));
          CHECK(step.share < step_max);
        }
      }
    }
  }
}

TEST_SUITE_END();

}  // namespace contract_switch_test
