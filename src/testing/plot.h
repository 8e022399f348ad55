// Draws a signal in a test's message.
#pragma once

#include <iosfwd>
#include <span>

namespace kadans::testing {

// A few lines: the curve, its range on the left, its duration below.
void plot(std::ostream& out, std::span<const double> values, double duration_s);

}  // namespace kadans::testing
