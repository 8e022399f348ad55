// What a timing test found, for people and for programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/realtime/jitter.h"

namespace kadans {

struct JitterRun {
  JitterSettings settings;
  bool load = false, keep_awake = true, latency_held = false;
  std::vector<JitterSample> own;           // the stretches, in turn with the yardstick's
  std::vector<YardstickSample> yardstick;  // as many, or none
  std::int64_t keep_awake_ns = 0;          // CPU time, over all of it
};

inline constexpr double verdict_share = 0.01;  // of the period: the bound of 2008

std::string jitter_text(const JitterRun& run);
std::string jitter_json(const JitterRun& run);  // one line
std::string jitter_svg(const JitterRun& run);   // both histograms of lateness, logarithmic both ways

// Of all stretches together.
JitterSample together(const std::vector<JitterSample>& stretches);
YardstickSample together(const std::vector<YardstickSample>& stretches);

}  // namespace kadans
