#include <algorithm>
#include <cmath>

#include "kadans/campaign/durable_file.h"
#include "kadans/signal/number_text.h"
#include "kadans/telemetry/signal_plot.h"
#include "kadans/telemetry/text_plot.h"
#include "log/log_verbs.h"
#include "terminal.h"

namespace kadans {
namespace {

constexpr std::size_t signals_max = 64;  // nobody can distinguish more lines
constexpr std::size_t sketch_columns = 72, sketch_rows = 4;

PlotFormat format_of(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".svg") return PlotFormat::svg;
  if (ending == ".png") return PlotFormat::png;
  throw InputError({.file = file, .message = "a plot's file ends with .svg or .png"});
}

// One value for each column of dots: the one that differs most from the column before, so that a peak is visible.
std::vector<double> evenly(const PlotLine& line, double from_s, double to_s) {
  constexpr std::size_t columns = 2 * sketch_columns;
  std::vector<double> values(columns, std::nan(""));
  double before = line.points.empty() ? 0 : line.points.front().value;
  const double per_s = static_cast<double>(columns) / std::max(to_s - from_s, 1e-9);
  for (std::size_t i = 0; i < line.points.size();) {
    const auto column_of = [&](const PlotPoint& point) {
      return std::min(columns - 1, static_cast<std::size_t>((point.time_s - from_s) * per_s));
    };
    const std::size_t column = column_of(line.points[i]);
    double value = line.points[i].value;
    for (; i < line.points.size() && column_of(line.points[i]) == column; ++i) {
      if (!(std::abs(line.points[i].value - before) <= std::abs(value - before))) value = line.points[i].value;
    }
    before = values[column] = value;
  }
  // A slow signal keeps its value between its rows.
  for (std::size_t i = 1; i < columns; ++i) {
    if (std::isnan(values[i])) values[i] = values[i - 1];
  }
  return values;
}

void sketch(const SignalPlot& plot) {
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotLine& line : panel.lines) {
      const TextPlot text = text_plot(evenly(line, plot.from_s, plot.to_s), sketch_columns, sketch_rows, true);
      std::printf("  %s%s\n", line.label.c_str(), panel.unit.empty() ? "" : (", " + panel.unit).c_str());
      for (std::size_t i = 0; i < text.lines.size(); ++i) {
        const bool edge = i == 0 || i + 1 == text.lines.size();
        std::printf("%s│%s\n", edge ? printed("  %10.4g ", i == 0 ? text.top : text.bottom).c_str() : "             ",
                    text.lines[i].c_str());
      }
      if (text.lines.empty()) std::printf("             (no value here is a number)\n");
    }
  }
  std::printf("              %-10.3f%*.3f s\n", plot.from_s, static_cast<int>(sketch_columns) - 12, plot.to_s);
  std::printf("a picture with states and faults: -o FILE.svg or FILE.png\n");
}

std::string title_of(const RecordOutline& record) {
  const std::string name = std::filesystem::path(record.file).filename().string();
  const std::string seed = record.fact("run", "seed");
  return name + (seed.empty() ? "" : ", seed " + seed);
}

}  // namespace

int log_plot(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  const PlotFormat format = options.out.empty() ? PlotFormat::svg : format_of(options.out);
  if (!options.out.empty()) require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, span);
  const std::vector<ChosenSignal> signals = choose_signals(record, options.signals);
  if (signals.size() > signals_max)
    throw InputError({.message = "these are " + std::to_string(signals.size()) + " signals; a plot of more than " +
                                 std::to_string(signals_max) + " cannot be read, choose fewer"});
  SignalPlot plot = plot_of(record, panels_by_unit(signals), span);
  plot.title = title_of(record);
  tell_problem(record);
  if (options.out.empty()) {
    sketch(plot);
    return exit_passed;
  }
  write_durably(options.out, draw(plot, format));
  std::printf("%s\n", options.out.c_str());
  return exit_passed;
}

}  // namespace kadans
