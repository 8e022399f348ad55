// An entry of the world model, as a configuration declares it: what the robot may know of one thing around it.
#pragma once

#include <string>
#include <vector>

#include "kadans/signal/capacity.h"

namespace kadans {

struct SeenField {
  std::string name;  // "x_m"
  std::string unit, doc;
  double min = 0, max = 0;  // what is outside is no observation
};

struct SeenInfo {
  std::string name;  // behaviors read it as s.seen.NAME
  std::string doc;
  // How many of its first fields are a place: 0; 2: x_m and y_m; 3: heading_rad, too. It is observed, and shown, in the
  // heading frame: its origin is below the base frame's, x points forward along the ground where the base points.
  std::size_t places = 0;
  std::vector<SeenField> fields;  // at most max_seen_fields
  double forget_s = 0;            // an observation of that age does not count any more; 0: it always counts
};

}  // namespace kadans
