// The results of a sweep over two quantities, as a picture.
#pragma once

#include <string>

#include "kadans/campaign/merged_sweep.h"

namespace kadans {

struct HeatMapOptions {
  std::string x, y;    // quantities
  std::string metric;  // "": the share that passed
};

// An SVG document. A quantity with few values has a column or row for each, else ten of the same width. Each field
// shows the mean or the share, its colour, and how many cases it is of. Throws InputError for an unknown name.
std::string heat_map_svg(const MergedSweep& sweep, const HeatMapOptions& options);

}  // namespace kadans
