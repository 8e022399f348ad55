// A small plot of a signal as text: braille characters with two by four dots each, or plain ASCII.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kadans {

struct TextPlot {
  std::vector<std::string> lines;  // from the top, each `columns` characters wide
  double top = 0, bottom = 0;      // values at the upper and lower edge
};

// Values that are not finite leave a gap. The range is that of the values; it is widened when all values are equal.
TextPlot text_plot(std::span<const double> values, std::size_t columns, std::size_t rows, bool unicode);

}  // namespace kadans
