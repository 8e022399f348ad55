// The kit for tests in doctest: one include, and every result of an experiment prints its numbers and a small plot when
// a check on it fails. Limits are compared with <=; single numbers with INFO:
//
//   const StepResponse response = step_response(bench, {.to = 0.2});
//   CHECK(response <= StepLimits{.overshoot_percent = 5, .settling_time_s = 0.3});
//   INFO(response);
//   CHECK(response.peak_time_s > 0.01);
//
// The rest of the kit does not need doctest: results are printed by operator<<, with any framework.
#pragma once

#include <sstream>

#include <doctest/doctest.h>

#include "kadans/testing/allocation_count.h"
#include "kadans/testing/frequency_response.h"
#include "kadans/testing/golden_record.h"
#include "kadans/testing/joint_bench.h"
#include "kadans/testing/step_response.h"
#include "kadans/testing/switch_record.h"
#include "kadans/testing/switching_stability.h"
#include "kadans/testing/tracking.h"

// doctest knows a container only as "{?}": without this the elements would not be printed.
namespace doctest {
template <>
struct StringMaker<kadans::testing::FrequencyResponse> {
  static String convert(const kadans::testing::FrequencyResponse& response) {
    std::ostringstream out;
    kadans::testing::operator<<(out, response);
    return out.str().c_str();
  }
};
}  // namespace doctest
