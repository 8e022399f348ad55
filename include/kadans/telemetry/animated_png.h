// Pictures one after the other as one animated PNG (https://www.w3.org/TR/png-3/#apng-frame-based-animation): the
// compressed data of each picture as it is, under a number.
#pragma once

#include <string>
#include <vector>

namespace kadans {

// All of one size, as one program wrote them. Throws std::runtime_error when one is no PNG or differs.
std::string animated_png(const std::vector<std::string>& pictures, int frames_per_s);

}  // namespace kadans
