
#include "telemetry/plot.h"

#include <algorithm>
#include <cmath>

#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

class SvgPicture {
 public:
  SvgPicture(const Plot& plot, const PlotArea& size)
      : plot_(plot), size_(size), right_(size.left + size.width), bottom_(size.top + size.height), y_(plot.y.range) {
    if (!(y_.low < y_.high)) y_ = widened(range_of(plot.lines), 0, 1e-9);
  }

  std::string write() {
    const double width = right_ + size_.right, height = bottom_ + size_.bottom;
    add(printed("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" ", width,
                height, width, height) +
        "role=\"img\" font-family=\"sans-serif\">\n");
    if (size_.left > 0)  // a small one inside of a page stands on the page's paper
      add(printed("<rect width=\"100%%\" height=\"100%%\" fill=\"%s\"/>\n", plot_ink::paper.light));
    if (!plot_.title.empty()) words(size_.left, size_.top - 12, "start", plot_.title, 14);
    axes();
    for (const PlotField& field : plot_.fields) draw(field);
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) draw(plot_.lines[i], color_of(i));
    keys();
    return text_ + "</svg>\n";
  }

 private:
  static double share(const PlotAxis& axis, PlotRange range, double value) {
    if (!axis.logarithmic) return (value - range.low) / (range.high - range.low);
    return std::log(std::max(value, range.low) / range.low) / std::log(range.high / range.low);
  }
  double x_of(double value) const { return size_.left + size_.width * share(plot_.x, plot_.x.range, value); }
  double y_of(double value) const { return bottom_ - size_.height * share(plot_.y, y_, value); }
  static const char* color_of(std::size_t line) { return plot_ink::lines.at(line % plot_ink::lines.size()).light; }

  void add(const std::string& text) { text_ += text; }
  void words(double x, double y, const char* anchor, const std::string& text, int size = 11,
             const std::string& ink = plot_ink::text.light, const char* more = "") {
    add(printed("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%d\" fill=\"%s\"%s>", x, y, anchor, size,
                ink.c_str(), more) +
        html_text(text) + "</text>\n");
  }
  void box(double x, double y, double width, double height, const std::string& color) {
    add(printed("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\" stroke=\"%s\"/>\n", x, y, width,
                height, color.c_str(), plot_ink::paper.light));
  }
  void rule(double x1, double y1, double x2, double y2) {
    if (!plot_.fields.empty()) return;
    add(printed("<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\"/>\n", x1, y1, x2, y2,
                plot_ink::grid.light));
  }

  void axes() {
    for (const PlotTick& tick : plot_.x.ticks) {
      rule(x_of(tick.at), size_.top, x_of(tick.at), bottom_);
      words(x_of(tick.at), bottom_ + 16, "middle", tick.label);
    }
    for (const PlotTick& tick : plot_.y.ticks) {
      rule(size_.left, y_of(tick.at), right_, y_of(tick.at));
      words(size_.left - 8, y_of(tick.at) + 4, "end", tick.label);
    }
    if (!plot_.x.name.empty()) words(size_.left + size_.width / 2, bottom_ + 40, "middle", plot_.x.name, 12);
    const double middle = size_.top + size_.height / 2;
    const std::string upwards = printed(" transform=\"rotate(-90 20 %.1f)\"", middle);
    if (!plot_.y.name.empty()) words(20, middle, "middle", plot_.y.name, 12, plot_ink::text.light, upwards.c_str());
  }

  void draw(const PlotField& field) {
    const auto column = static_cast<double>(field.column), row = static_cast<double>(field.row);
    const double x = x_of(column), y = y_of(row + 1), width = x_of(column + 1) - x, height = y_of(row) - y;
    box(x, y, width, height, field.color);
    if (field.text.empty()) return;
    words(x + width / 2, y + 16, "middle", field.text, 11, field.ink);
    words(x + width / 2, y + 29, "middle", field.small_text, 9, field.ink);
  }

  void draw(const PlotLine& line, const char* color) {
    std::string path;
    bool joined = false;
    for (const PlotPoint& point : line.points) {
      const bool finite = std::isfinite(point.y);
      if (finite) path += printed("%s%.1f %.1f", joined ? " L" : " M", x_of(point.x), y_of(point.y));
      joined = finite;
    }
    add("<path d=\"" + path + printed("\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\"/>\n", color));
  }

  void keys() {
    std::vector<PlotKey> all = plot_.key;
    for (std::size_t i = 0; i < plot_.lines.size(); ++i) {
      if (!plot_.lines[i].label.empty()) all.push_back({color_of(i), plot_.lines[i].label});
    }
    double y = size_.top;
    for (const PlotKey& key : all) {
      box(right_ + 20, y, 18, 22, key.color);
      words(right_ + 44, y + 15, "start", key.label);
      y += 22;
    }
  }

  const Plot& plot_;
  const PlotArea& size_;
  double right_, bottom_;
  PlotRange y_;
  std::string text_;
};

}  // namespace

PlotLine plot_line(const std::string& label, std::span<const double> values, double from, double to) {
  PlotLine line{.label = label, .points = {}};
  const double step = (to - from) / std::max(1.0, static_cast<double>(values.size()) - 1);
  for (std::size_t i = 0; i < values.size(); ++i)
    line.points.push_back({from + step * static_cast<double>(i), values[i]});
  return line;
}

PlotRange range_of(std::span<const PlotLine> lines) {
  PlotRange range{INFINITY, -INFINITY};
  for (const PlotLine& line : lines) {
    for (const PlotPoint& point : line.points) {
      if (!std::isfinite(point.y)) continue;
      range.low = std::min(range.low, point.y);
      range.high = std::max(range.high, point.y);
    }
  }
  return range;
}

PlotRange widened(PlotRange range, double margin, double alike) {
  if (!(range.low <= range.high)) return {0, 1};
  double wider = margin * (range.high - range.low);
  if (!(range.high - range.low > alike * std::max(std::abs(range.low), std::abs(range.high))))
    wider = range.low == 0 ? 1 : 0.1 * std::abs(range.low);
  return {range.low - wider, range.high + wider};
}

std::string plot_svg(const Plot& plot, const PlotArea& size) { return SvgPicture(plot, size).write(); }

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
