// The result of a timing test, for people and for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "realtime/machine/jitter.h"

namespace kadans {

struct JitterRun {
  JitterSettings settings;
  bool load = false, keep_awake = true, latency_held = false;
  std::vector<JitterSample> own;           // our measurements, in turn with those of cyclictest
  std::vector<YardstickSample> yardstick;  // as many measurements, or none
  std::int64_t keep_awake_ns = 0;          // CPU time of all measurements together
};

inline constexpr double verdict_share = 0.01;  // share of the period: the bound of 2008

std::string jitter_text(const JitterRun& run);
std::string jitter_json(const JitterRun& run);  // one line
std::string jitter_svg(const JitterRun& run);   // both histograms of lateness, on logarithmic axes

// All measurements as one sample.
JitterSample together(const std::vector<JitterSample>& stretches);
YardstickSample together(const std::vector<YardstickSample>& stretches);

}  // namespace kadans
