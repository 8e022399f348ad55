#include "plot.h"

#include <cstdio>
#include <ostream>
#include <string>

#include "kadans/telemetry/text_plot.h"

namespace kadans::testing {
namespace {

constexpr std::size_t columns = 60, rows = 6;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%10.4g", value);
  return text;
}

}  // namespace

void plot(std::ostream& out, std::span<const double> values, double duration_s) {
  const TextPlot drawn = text_plot(values, columns, rows, true);
  for (std::size_t i = 0; i < drawn.lines.size(); ++i) {
    const bool edge = i == 0 || i + 1 == drawn.lines.size();
    out << "  " << (edge ? number(i == 0 ? drawn.top : drawn.bottom) : std::string(10, ' ')) << " |" << drawn.lines[i]
        << '\n';
  }
  if (drawn.lines.empty()) out << "  (nothing finite to draw)\n";
  out << "             0 .. " << duration_s << " s\n";
}

}  // namespace kadans::testing
