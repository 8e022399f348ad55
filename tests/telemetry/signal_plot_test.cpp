// What a plot shows: nothing that was there is thinned away, and it stays small.
#include "telemetry/plot/signal_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <doctest/doctest.h>

#include "written_record.h"

using namespace kadans;

namespace {

bool gnuplot_is_here() { return std::system("gnuplot --version >/dev/null 2>&1") == 0; }  // NOLINT: the shell's PATH

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Transition moved(double time_s, const std::string& from, const std::string& to, const std::string& behavior = "walk") {
  return {.time_ns = std::llround(time_s * 1e9), .behavior = behavior, .from = from, .to = to, .why = ""};
}

std::string text_of(const std::vector<PlotLane>& lanes) {
  std::string text;
  for (const PlotLane& lane : lanes) {
    text += lane.name + ":";
    for (const PlotBand& band : lane.bands)
      text += " " + band.label + " " + std::to_string(std::lround(10 * band.from_s)) + "-" +
              std::to_string(std::lround(10 * band.to_s));
    text += ";";
  }
  return text;
}

SignalPlot knee_plot(WrittenRecord& record) {
  write_knee(record);
  const RecordOutline outline = record.outline();
  SignalPlot plot = plot_of(outline, panels_by_unit(choose_signals(outline, {})), {});
  plot.title = "it's a \"knee\"\n'; system('true')";
  return plot;
}

}  // namespace

TEST_CASE("lanes of active states: each region keeps its own, and what begins together is there from its beginning") {
  const auto told = [](double time_s, std::vector<std::string> states) {
    return Event{.kind = Event::Kind::active,
                 .transition = {std::llround(1e9 * time_s), "walk", "", "", ""},
                 .states = std::move(states)};
  };
  CHECK(text_of(state_lanes(
            {told(0, {"wait"}), told(1, {"go.left.up", "go.right.in"}), told(2, {"go.left.up", "go.right.out"}),
             told(2.5, {"go.left.down", "go.right.out"}), told(3, {"done"}), told(3.5, {})},
            0, 4)) ==
        "walk: wait 0-10 go.left.up 10-25 go.left.down 25-30 done 30-35;walk: go.right.in 10-20 go.right.out 20-30;");
}

TEST_CASE("a signal is thinned to a bounded number of points that keep its ends and each of its peaks") {
  PlotColumns columns(0, 100, 50);
  constexpr int rows = 100'000;
  for (int i = 0; i < rows; ++i) columns.add(1e-3 * i, i == 33'333 ? 9.0 : i == 66'666 ? -9.0 : std::sin(1e-3 * i));
  const std::vector<PlotPoint> points = columns.points();
  CHECK(points.size() <= 4 * 50);
  CHECK(points.size() > 50);
  const auto value = [](const PlotPoint& point) { return point.y; };
  CHECK(std::ranges::max(points, {}, value).x == doctest::Approx(33.333));
  CHECK(std::ranges::min(points, {}, value).x == doctest::Approx(66.666));
  CHECK(points.front().x == 0);
  CHECK(points.back().x == doctest::Approx(99.999));
  CHECK(std::ranges::is_sorted(points, {}, [](const PlotPoint& point) { return point.x; }));
}

TEST_CASE("where a signal is no number its line is interrupted") {
  PlotColumns columns(0, 10, 10);
  for (int i = 0; i < 10; ++i) columns.add(i, i == 4 || i == 5 ? std::nan("") : i);
  const std::vector<PlotPoint> points = columns.points();
  REQUIRE(points.size() == 9);
  CHECK(points[3].y == 3);
  CHECK(std::isnan(points[4].y));
  CHECK(points[5].y == 6);
}

TEST_CASE("the states of a behavior follow each other, from the one that the first transition left") {
  CHECK(text_of(state_lanes({moved(1, "lie", "rise"), moved(2.5, "rise", "stand")}, 0, 4)) ==
        "walk: lie 0-10 rise 10-25 stand 25-40;");
  CHECK(text_of(state_lanes({moved(1, "", "rise"), moved(3, "rise", "done")}, 2, 2.5)) == "walk: rise 20-25;");
  CHECK(text_of(state_lanes({moved(1, "a", "b"), moved(2, "b.inner", "c")}, 0, 3)) == "walk: a 0-10 b 10-20 c 20-30;");
}

TEST_CASE("states that go on side by side have lanes of their own, which end together when what is around them does") {
  CHECK(text_of(state_lanes({moved(1, "go.left.up", "go.left.down"), moved(2, "go.right.in", "go.right.out"),
                             moved(3, "go.left.down", "go.left.up"), moved(4, "go", "stop")},
                            0, 5)) ==
        "walk: go.left.up 0-10 go.left.down 10-30 go.left.up 30-40 stop 40-50;walk: go.right.in 0-20 go.right.out "
        "20-40;");
  CHECK(text_of(state_lanes({moved(1, "a", "b"), moved(2, "x", "y", "wave")}, 0, 3)) ==
        "walk: a 0-10 b 10-30;wave: x 0-20 y 20-30;");
}

TEST_CASE("a plot has a panel for each unit, the states as boxes, faults as lines, and a slow signal all its time") {
  WrittenRecord record;
  const SignalPlot plot = knee_plot(record);
  REQUIRE(plot.panels.size() == 3);
  CHECK(plot.panels[0].unit == "rad");
  CHECK(plot.panels[2].unit == "C");
  CHECK(plot.panels[2].lines[0].points.size() == 10);
  CHECK(text_of(plot.lanes) == "bend: up 0-0 down 0-1 up 1-1;");
  REQUIRE(plot.marks.size() == 1);
  CHECK(plot.marks[0].label == "motor_hot of knee");
  const std::string script = gnuplot_script(plot, PlotFormat::svg);
  CHECK(count(script, "set object rect from first") == 3 + 3);  // the states, and the second one behind each panel
  CHECK(count(script, "set arrow from") == 3);
  CHECK(count(script, "'motor_hot of knee'") == 1);
  CHECK(count(script, "title 'knee.angle_rad'") == 1);
  for (const char* unit : {"set label 'rad' ", "set label 'Nm' ", "set label 'C' ", "set xlabel 'time, s'"})
    CHECK(count(script, unit) == 1);
}

TEST_CASE("a plot of a stretch begins with what the signals held") {
  WrittenRecord record;
  write_knee(record);
  const RecordOutline outline = record.outline();
  const SignalPlot plot = plot_of(outline, panels_by_unit(choose_signals(outline, {"slow"})), {35'000'000, 62'000'000});
  CHECK(plot.from_s == doctest::Approx(0.035));
  CHECK(plot.to_s == doctest::Approx(0.062));
  const std::vector<PlotPoint>& points = plot.panels.at(0).lines.at(0).points;
  REQUIRE(points.size() == 4);
  CHECK(points[0].x == doctest::Approx(0.035));
  CHECK(points[0].y == 20.3);
  CHECK(points[1].x == doctest::Approx(0.04));
}

TEST_CASE("of faults that stand close together one is named, with how many more there are") {
  const SignalPlot plot{.title = "",
                        .from_s = 0,
                        .to_s = 10,
                        .panels = {{.title = "", .unit = "m", .lines = {{"height", {{0, 1}, {10, 2}}}}}},
                        .lanes = {},
                        .marks = {{1, "tilt"}, {1.001, "fall"}, {1.2, "impact"}, {8, "push", false}}};
  const std::string script = gnuplot_script(plot, PlotFormat::svg);
  CHECK(count(script, "'tilt +2'") == 1);
  CHECK(count(script, "'push'") == 1);
  CHECK(count(script, "'fall'") == 0);
  CHECK(count(script, "set arrow from") == 3);  // those that fall on one column of the picture are one line
}

TEST_CASE("names mean nothing to gnuplot, whatever they hold") {
  WrittenRecord record;
  const std::string script = gnuplot_script(knee_plot(record), PlotFormat::png);
  CHECK(count(script, "'it''s a \"knee\" ''; system(''true'')'") == 1);
}

TEST_CASE("gnuplot draws SVG and PNG of the size that is asked for") {
  if (!gnuplot_is_here()) {
    MESSAGE("skipped: gnuplot is not installed");
    return;
  }
  WrittenRecord record;
  SignalPlot plot = knee_plot(record);
  plot.panels[1].lines[0].points.clear();  // one without any value
  const std::string svg = draw(plot, PlotFormat::svg, {.width = 700, .panel_height = 100});
  CHECK(count(svg, "<svg") == 1);
  CHECK(count(svg, "width=\"700\"") >= 1);
  CHECK(count(svg, "</svg>") == 1);
  CHECK(count(svg, "knee.angle_rad") >= 1);
  CHECK(count(svg, ">motor_hot of knee<") == 1);
  const std::string png = draw(plot, PlotFormat::png, {.width = 700, .panel_height = 100});
  CHECK(png.substr(1, 3) == "PNG");
  CHECK(static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]) == 700);
}
