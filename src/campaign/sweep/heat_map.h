// The results of a sweep over two quantities, as a picture.
#pragma once

#include <string>

#include "merged_sweep.h"

namespace kadans {

struct HeatMapOptions {
  std::string x, y;    // quantities
  std::string metric;  // "": the share that passed
};

// An SVG document. A quantity with few values has a column or row for each value; any other has ten of equal width.
// Each field shows the mean or the share as a number and as a colour, and how many cases it covers. Throws InputError
// for an unknown name.
std::string heat_map_svg(const MergedSweep& sweep, const HeatMapOptions& options);

}  // namespace kadans
