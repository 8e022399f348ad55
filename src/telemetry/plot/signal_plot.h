// Plots signals over time: panels below each other on a common time axis. The states of behaviors are a strip of named
// boxes above the panels and shades behind them; faults are vertical lines through everything.
//
// A record has more rows than a picture has columns. The first, lowest, highest and last value of each column are kept.
// Lines through these values look the same as lines through all values (Jugel et al., M4, VLDB 2014). So a peak of one
// tick is visible, and the size of the picture does not grow with the record. The external program gnuplot draws the
// picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "telemetry/plot.h"
#include "telemetry/reading/record_rows.h"

namespace kadans {

// Reduces one signal to the given number of columns between two times.
class PlotColumns {
 public:
  PlotColumns(double from_s, double to_s, std::size_t columns) noexcept;
  void add(double time_s, double value);  // time must not run backwards
  std::vector<PlotPoint> points();        // call it once, at the end

 private:
  struct Column {
    PlotPoint first, lowest, highest, last;
  };
  void end_column();

  double from_s_, per_s_;
  std::size_t columns_, at_ = 0;
  bool open_ = false;
  Column column_;
  std::vector<PlotPoint> points_;
};

struct PlotPanel {
  std::string title;  // may be ""
  std::string unit;
  std::vector<PlotLine> lines;
};
struct PlotBand {
  double from_s = 0, to_s = 0;
  std::string label;
};
struct PlotLane {  // the states of one behavior or of one of its regions
  std::string name;
  std::vector<PlotBand> bands;
};
struct PlotMark {
  double time_s = 0;
  std::string label;
  bool fault = true;  // else a disturbance, such as a push
};
struct SignalPlot {
  std::string title;
  double from_s = 0, to_s = 0;
  std::vector<PlotPanel> panels;
  std::vector<PlotLane> lanes;
  std::vector<PlotMark> marks;
};

// The states of the behaviors as lanes: one lane for each behavior, or one for each region when its chart has parallel
// regions. A state begins with its transition. Before the first transition, the active state is the one that this
// transition left.
std::vector<PlotLane> state_lanes(const std::vector<Transition>& transitions, double from_s, double to_s);
// The same by what is active (RecordOutline::active), which also knows the states in which regions begin.
std::vector<PlotLane> state_lanes(const std::vector<Event>& active, double from_s, double to_s);

// The signals that a panel shall show. Its unit is that of the signals.
struct PanelWish {
  std::string title;
  std::vector<ChosenSignal> signals;
};
// One panel for each unit, in the order in which the units first appear.
std::vector<PanelWish> panels_by_unit(const std::vector<ChosenSignal>& signals);

// Reads the signals from the record and reduces each to `columns` columns.
SignalPlot plot_of(const RecordOutline& record, const std::vector<PanelWish>& wishes, TimeSpan span,
                   std::size_t columns = 600);

enum class PlotFormat : std::uint8_t { svg, png };
struct PlotSize {
  int width = 1200;
  int panel_height = 190;  // grows when the list of names beside it is long
};
// The script for gnuplot.
std::string gnuplot_script(const SignalPlot& plot, PlotFormat format, PlotSize size = {});
// Draws the plot and returns the bytes of the picture. Throws InputError when gnuplot fails or is not installed; then
// it says how to install it.
std::string draw(const SignalPlot& plot, PlotFormat format, PlotSize size = {});

// CSS for a page that holds such an SVG: other colors when the reader prefers a dark page.
std::string dark_plot_style();

}  // namespace kadans
