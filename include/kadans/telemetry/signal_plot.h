// Signals over time as a picture: panels one below the other on one axis of time, the states of behaviors as a strip of
// named boxes above and as shades behind, faults as lines through all of it.
//
// A record has more rows than a picture has columns. Of each column the first, lowest, highest and last value are kept:
// lines drawn through these look as lines through all (Jugel et al., M4, VLDB 2014), so a peak of one tick shows, and
// the picture's size is bounded whatever the record's. Gnuplot draws it, a program of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "kadans/telemetry/plot.h"
#include "kadans/telemetry/record_outline.h"

namespace kadans {

// Thins one signal to so many columns between two times.
class PlotColumns {
 public:
  PlotColumns(double from_s, double to_s, std::size_t columns) noexcept;
  void add(double time_s, double value);  // time never goes back
  std::vector<PlotPoint> points();        // at the end

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
struct PlotLane {  // what one behavior, or one of its regions, goes through
  std::string name;
  std::vector<PlotBand> bands;
};
struct PlotMark {
  double time_s = 0;
  std::string label;
  bool fault = true;  // else something that was done to the robot
};
struct SignalPlot {
  std::string title;
  double from_s = 0, to_s = 0;
  std::vector<PlotPanel> panels;
  std::vector<PlotLane> lanes;
  std::vector<PlotMark> marks;
};

// The states in which behaviors were, as lanes: one each, more for one whose regions go on side by side. A state begins
// with its transition; what was active before the first one is the state that it left.
std::vector<PlotLane> state_lanes(const std::vector<Transition>& transitions, double from_s, double to_s);

// What a panel is to show. Without a unit of its own: that of its signals.
struct PanelWish {
  std::string title;
  std::vector<ChosenSignal> signals;
};
// One panel for each unit, in the order in which they first come.
std::vector<PanelWish> panels_by_unit(const std::vector<ChosenSignal>& signals);

// Reads the signals out of the record. `columns`: into which each is thinned.
SignalPlot plot_of(const RecordOutline& record, const std::vector<PanelWish>& wishes, TimeSpan span,
                   std::size_t columns = 600);

enum class PlotFormat : std::uint8_t { svg, png };
struct PlotSize {
  int width = 1200;
  int panel_height = 190;  // grows with the names beside it
};
// What gnuplot is told.
std::string gnuplot_script(const SignalPlot& plot, PlotFormat format, PlotSize size = {});
// The picture's bytes. Throws InputError when there is no gnuplot, with the way to get it, or when it fails.
std::string draw(const SignalPlot& plot, PlotFormat format, PlotSize size = {});

// CSS for a page with such an SVG inside: other inks where the reader has it dark.
std::string dark_plot_style();

}  // namespace kadans
