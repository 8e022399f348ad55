// Plots that need no other program: what the text and the SVG hold.
#include "telemetry/plot.h"

#include <cmath>

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("a curve as text shows its peak of one value, its gap and its range") {
  std::vector<double> values(1000, 0.0);
  values[500] = 1;
  for (std::size_t i = 700; i < 800; ++i) values[i] = std::nan("");
  CHECK(curve_text("knee, rad", values, 0, 2, {.columns = 20, .rows = 3, .unicode = false}) ==
        "  knee, rad\n"
        "           1 |          *         \n"
        "             |          *         \n"
        "           0 |************** *****\n"
        "              0                2 s\n");
  CHECK(curve_text("", std::vector<double>(5, std::nan("")), 0, 1).find("no value here is a number") !=
        std::string::npos);
}

TEST_CASE("a curve that stays where it is fills no plot with its last digits") {
  const PlotLine still = plot_line("", std::vector<double>{2, 2 + 1e-12}, 0, 1);
  const PlotRange range = widened(range_of({&still, 1}), 0, 1e-3);
  CHECK(range.low == doctest::Approx(1.8));
  CHECK(range.high == doctest::Approx(2.2));
  CHECK(widened(range_of({}), 0, 1e-3).high == 1);
}

TEST_CASE("a plot as SVG has its words, its ticks and its curves, interrupted where they are no number") {
  const Plot plot{.title = "a < b",
                  .x = {.name = "time, s", .range = {0, 1}, .ticks = {{0, "none"}, {1, "all"}}},
                  .lines = {{"knee", {{0, 0}, {0.5, std::nan("")}, {1, 1}}}}};
  const std::string svg = plot_svg(plot);
  for (const char* part : {"viewBox=\"0 0 810 360\"", ">a &lt; b<", ">time, s<", ">none<", ">all<", ">knee<",
                           "d=\" M60.0 310.0 M700.0 30.0\"", "</svg>"})
    CHECK_MESSAGE(svg.find(part) != std::string::npos, part);
}
