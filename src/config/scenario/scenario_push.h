// A push on a link of the robot: a force that acts for a time.
#pragma once

#include <vector>

#include "config/json/fields.h"
#include "kadans/signal/frames.h"

namespace kadans {

inline constexpr double push_max_Ns = 1e4;  // along each axis

struct ScenarioPush {
  enum class Shape : std::uint8_t { constant, half_sine };
  PlacedName link;
  double at_s = 0;
  double duration_s = 0.1;
  Vec3 impulse_Ns{};  // world axes; the integral of the force
  Vec3 point_m{};     // in the link's frame
  Shape shape = Shape::constant;
};

// The fields of one push, with "impulse_Ns" or "force_N" (its peak).
void push_fields(Fields& f, ScenarioPush& push, Problems& problems);

}  // namespace kadans
