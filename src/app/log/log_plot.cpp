#include <cstdio>

#include "app/terminal.h"
#include "campaign/work/durable_file.h"
#include "log_verbs.h"
#include "telemetry/plot/signal_plot.h"

namespace kadans {
namespace {

constexpr std::size_t signals_max = 64;  // nobody can distinguish more lines
constexpr std::size_t sketch_columns = 72;

PlotFormat format_of(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".svg") return PlotFormat::svg;
  if (ending == ".png") return PlotFormat::png;
  throw InputError({.file = file, .message = "a plot's file ends with .svg or .png"});
}

void sketch(const SignalPlot& plot) {
  for (const PlotPanel& panel : plot.panels) {
    const Plot one{
        .x = {.name = "s", .range = {plot.from_s, plot.to_s}}, .y = {.name = panel.unit}, .lines = panel.lines};
    std::printf("%s\n", plot_text(one, {.columns = sketch_columns}).c_str());
  }
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
