#include "kadans/telemetry/text_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kadans/signal/utf8.h"

namespace kadans {
namespace {

// A grid of dots in which a curve is drawn as a line without gaps.
class Canvas {
 public:
  Canvas(std::size_t width, std::size_t height) : width_(width), height_(height), dots_(width * height, 0) {}

  void column(std::size_t x, std::size_t from, std::size_t to) {
    for (std::size_t y = std::min(from, to); y <= std::max(from, to); ++y) dots_[y * width_ + x] = 1;
  }
  bool dot(std::size_t x, std::size_t y) const { return dots_[y * width_ + x] != 0; }
  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }

 private:
  std::size_t width_, height_;
  std::vector<char> dots_;
};

void append_braille(const Canvas& canvas, std::size_t column, std::size_t row, std::string& line) {
  // Unicode 2800: bits 0-2 and 6 are the left column from the top, bits 3-5 and 7 the right one.
  constexpr unsigned bit[2][4] = {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}};
  std::uint32_t pattern = 0;
  for (std::size_t x = 0; x < 2; ++x) {
    for (std::size_t y = 0; y < 4; ++y) {
      if (canvas.dot(2 * column + x, 4 * row + y)) pattern |= bit[x][y];
    }
  }
  append_utf8(0x2800U + pattern, line);
}

void draw(Canvas& canvas, std::span<const double> values, double bottom, double top) {
  const auto row_of = [&](double value) {
    const double share = (top - value) / (top - bottom);
    return static_cast<std::size_t>(std::lround(share * static_cast<double>(canvas.height() - 1)));
  };
  bool joined = false;
  std::size_t last = 0;
  for (std::size_t x = 0; x < canvas.width(); ++x) {
    const double value = values[x * (values.size() - 1) / std::max<std::size_t>(canvas.width() - 1, 1)];
    if (!std::isfinite(value)) {
      joined = false;
      continue;
    }
    const std::size_t y = row_of(value);
    canvas.column(x, joined ? last : y, y);
    last = y;
    joined = true;
  }
}

}  // namespace

TextPlot text_plot(std::span<const double> values, std::size_t columns, std::size_t rows, bool unicode) {
  TextPlot plot;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) return plot;
  const double least = std::max(1e-9, 1e-3 * std::max(std::abs(low), std::abs(high)));
  if (high - low < least) {
    low -= 0.5 * least;
    high += 0.5 * least;
  }
  plot.top = high;
  plot.bottom = low;
  Canvas canvas(unicode ? 2 * columns : columns, unicode ? 4 * rows : rows);
  draw(canvas, values, low, high);
  for (std::size_t row = 0; row < rows; ++row) {
    std::string line;
    for (std::size_t column = 0; column < columns; ++column) {
      if (unicode) {
        append_braille(canvas, column, row, line);
      } else {
        line += canvas.dot(column, row) ? '*' : ' ';
      }
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

}  // namespace kadans
