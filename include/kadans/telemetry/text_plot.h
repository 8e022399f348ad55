// A signal as a small plot in text: braille dots, two by four a character, or plain ASCII.
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

// Values that are not finite leave a gap. The range is that of the values, widened when they are all alike.
TextPlot text_plot(std::span<const double> values, std::size_t columns, std::size_t rows, bool unicode);

}  // namespace kadans
