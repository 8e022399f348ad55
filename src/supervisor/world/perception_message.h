// What a detector in a program of its own tells the supervisor: one datagram of JSON (docs/supervisor.md).
//
//   {"kadans": 1, "seen": [{"entry": "ball", "age_s": 0.06, "confidence": 0.9, "x_m": 1.2, "y_m": -0.1}]}
//
// `age_s` is how old the picture was when the datagram was sent, so no clock is shared. Every byte is hostile until it
// is checked: size, syntax, keys, types, and then by the world model ranges and times.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/signal/observation.h"
#include "kadans/signal/seen_info.h"

namespace kadans {

inline constexpr std::size_t perception_bytes_max = 2048, perception_seen_max = 32;
inline constexpr double perception_age_max_s = 60;

// Appends the observations of a datagram that came at `now_ns`. Returns "", or what is wrong: then nothing is appended.
std::string read_perception(std::string_view datagram, const std::vector<SeenInfo>& declared, std::int64_t now_ns,
                            std::vector<Observation>& observations);

}  // namespace kadans
