// Joins pictures into one animated PNG (https://www.w3.org/TR/png-3/#apng-frame-based-animation). The compressed data
// of each picture is copied unchanged and gets a sequence number.
#pragma once

#include <string>
#include <vector>

namespace kadans {

// All pictures must have the same size and format, as one program writes them. Throws std::runtime_error when one is no
// PNG or differs.
std::string animated_png(const std::vector<std::string>& pictures, int frames_per_s);

}  // namespace kadans
