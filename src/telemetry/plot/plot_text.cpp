#include <algorithm>
#include <cmath>

#include "signal/number_text.h"
#include "signal/utf8.h"
#include "telemetry/plot.h"

namespace kadans {
namespace {

// The dots of one column that a curve covers, from the top; none: a gap.
struct Stroke {
  std::size_t top = 1, bottom = 0;

  bool covers(std::size_t row) const { return top <= row && row <= bottom; }
  void add(std::size_t row) {
    const bool none = top > bottom;
    top = none ? row : std::min(top, row);
    bottom = none ? row : std::max(bottom, row);
  }
};

std::vector<Stroke> strokes_of(const PlotLine& line, PlotRange x, PlotRange y, std::size_t width, std::size_t height) {
  const auto dot = [](double share, std::size_t dots) {
    return static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * static_cast<double>(dots - 1)));
  };
  std::vector<Stroke> strokes(width);
  bool drawn = false;  // up to this column, at this row
  std::size_t column = 0, row = 0;
  const auto hold_until = [&](std::size_t end) {
    while (drawn && column < end) strokes[++column].add(row);
    column = end;
  };
  for (const PlotPoint& point : line.points) {
    hold_until(dot((point.x - x.low) / std::max(x.high - x.low, 1e-9), width));
    drawn = std::isfinite(point.y);
    if (!drawn) continue;
    row = dot((y.high - point.y) / (y.high - y.low), height);
    strokes[column].add(row);
  }
  hold_until(width - 1);
  return strokes;
}

void append_braille(const std::vector<Stroke>& strokes, std::size_t column, std::size_t row, std::string& text) {
  // Unicode 2800: bits 0-2 and 6 are the left column from the top, bits 3-5 and 7 the right one.
  constexpr unsigned bit[2][4] = {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}};
  std::uint32_t pattern = 0;
  for (std::size_t x = 0; x < 2; ++x) {
    for (std::size_t y = 0; y < 4; ++y) {
      if (strokes[2 * column + x].covers(4 * row + y)) pattern |= bit[x][y];
    }
  }
  append_utf8(0x2800U + pattern, text);
}

std::string rows_of(const PlotLine& line, PlotRange x, const PlotText& style) {
  const std::string indent(style.indent, ' '), no_edge(style.indent + 11, ' ');
  PlotRange y = range_of({&line, 1});
  if (!(y.low <= y.high)) return no_edge + "(no value here is a number)\n";
  y = widened(y, 0, 1e-3);
  const std::vector<Stroke> strokes = strokes_of(line, x, y, style.unicode ? 2 * style.columns : style.columns,
                                                 style.unicode ? 4 * style.rows : style.rows);
  const std::string frame = style.unicode ? "│" : "|";
  std::string text;
  for (std::size_t row = 0; row < style.rows; ++row) {
    const bool edge = row == 0 || row + 1 == style.rows;
    text += edge ? indent + printed("%10.4g ", row == 0 ? y.high : y.low) : no_edge;
    text += style.color ? "\033[2m" + frame + "\033[0m" : frame;
    for (std::size_t column = 0; column < style.columns; ++column) {
      if (style.unicode) {
        append_braille(strokes, column, row, text);
      } else {
        text += strokes[column].covers(row) ? '*' : ' ';
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string plot_text(const Plot& plot, const PlotText& style) {
  std::string text;
  for (const PlotLine& line : plot.lines) {
    if (!line.label.empty())
      text += std::string(style.indent, ' ') + line.label + (plot.y.name.empty() ? "" : ", " + plot.y.name) + '\n';
    text += rows_of(line, plot.x.range, style);
  }
  return text + std::string(style.indent + 12, ' ') +
         printed("%-12.9g%*.9g ", plot.x.range.low, static_cast<int>(style.columns) - 14, plot.x.range.high) +
         plot.x.name + '\n';
}

std::string curve_text(const std::string& label, std::span<const double> values, double from_s, double to_s,
                       const PlotText& style) {
  return plot_text({.x = {.name = "s", .range = {from_s, to_s}}, .lines = {plot_line(label, values, from_s, to_s)}},
                   style);
}

}  // namespace kadans
