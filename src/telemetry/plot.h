// A plot: curves, or the fields of a map, over two axes. It is drawn as text, for terminals, logs and tests that fail,
// and as SVG; neither needs another program. Plots of records, of many panels with states and faults, are made of the
// same curves and drawn by gnuplot (signal_plot.h).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kadans {

struct PlotPoint {
  double x = 0, y = 0;  // y is NaN: the curve is interrupted
};
struct PlotLine {
  std::string label;
  std::vector<PlotPoint> points;  // x never goes back
};
// Evenly spaced from x to x.
PlotLine plot_line(const std::string& label, std::span<const double> values, double from, double to);

struct PlotTick {
  double at = 0;
  std::string label;
};
struct PlotRange {
  double low = 0, high = 0;
};
struct PlotAxis {
  std::string name;  // a quantity or a unit; may be ""
  PlotRange range;
  bool logarithmic = false;     // in SVG
  std::vector<PlotTick> ticks;  // in SVG
};
struct PlotField {  // of a map whose axes count columns and rows
  std::size_t column = 0, row = 0;
  std::string color, ink, text, small_text;
};
struct PlotKey {
  std::string color, label;
};
struct Plot {
  std::string title;
  PlotAxis x, y;  // y: the range of the curves where it has none
  std::vector<PlotLine> lines;
  std::vector<PlotField> fields;
  std::vector<PlotKey> key;  // beside the names of the curves
};

PlotRange range_of(std::span<const PlotLine> lines);  // of all y that are finite; low > high: none is
// By a share of itself at both ends. What is alike but for a share of its size is not blown up to fill a plot.
PlotRange widened(PlotRange range, double margin, double alike);

struct PlotText {
  std::size_t columns = 60, rows = 4;  // of each curve
  std::size_t indent = 2;
  bool unicode = true;  // braille dots, two by four a character; else one star a character
  bool color = false;
};
// The curves one below the other, each with its name and on a range of its own. Values that share a column are all
// covered, so that a peak shows; a value holds until the next.
std::string plot_text(const Plot& plot, const PlotText& style = {});
// Of one curve over time.
std::string curve_text(const std::string& label, std::span<const double> values, double from_s, double to_s,
                       const PlotText& style = {});

struct PlotArea {
  double width = 640, height = 280;  // of the area of the curves
  double left = 60, top = 30, right = 110, bottom = 50;
};
std::string plot_svg(const Plot& plot, const PlotArea& size = {});

// The colors of a plot on light and on dark paper.
struct PlotColor {
  const char *light, *dark;
};

namespace plot_ink {
inline constexpr PlotColor paper{"#fefefe", "#12181e"}, text{"#1c2833", "#dde5ec"}, frame{"#8a97a3", "#5a6874"},
    grid{"#d9e0e6", "#232d36"}, shade{"#f1f4f7", "#19212a"}, fault{"#c62828", "#ff8a80"}, push{"#6a3d9a", "#c5a3ea"};
// Colors that color-blind readers can tell apart, too (Okabe and Ito), on light and dark paper.
inline constexpr std::array<PlotColor, 8> lines{{{"#0072b2", "#4ba9e0"},
                                                 {"#d55e00", "#f28a3c"},
                                                 {"#009e73", "#3cc79b"},
                                                 {"#cc79a7", "#dd95bd"},
                                                 {"#e69f00", "#f0b73a"},
                                                 {"#56b4e9", "#86cbf2"},
                                                 {"#8c6d31", "#c09a55"},
                                                 {"#7f7f7f", "#a5a5a5"}}};
inline constexpr std::array<PlotColor, 6> states{{{"#cfe3f2", "#1f4460"},
                                                  {"#f7dfc4", "#5b3c1c"},
                                                  {"#cfeadd", "#1d4d3a"},
                                                  {"#efd8e6", "#53304a"},
                                                  {"#f4ecc2", "#4d4419"},
                                                  {"#dcdff2", "#353a66"}}};
}  // namespace plot_ink

}  // namespace kadans
