#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "log_verbs.h"
#include "signal/durable_file.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "telemetry/plot/signal_plot.h"
#include "telemetry/reading/record_export.h"
#include "telemetry/reading/record_observations.h"

namespace kadans {
namespace {

int log_cut(const LogOptions& options) {
  const RecordCut cut{.span = span_of(options), .signals = options.signals, .inputs = options.inputs};
  if (options.inputs && options.from_s)
    refuse("--from", "does not go with --inputs: a run is repeated from its record's beginning");
  require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, cut.span);
  UnfinishedFile file(options.out);
  const CutRecord made = cut_record(record, cut, file.path());
  file.finish();
  std::printf("%s: %s, %s, %.1f kB\n", options.out.c_str(), plural(made.messages, "message").c_str(),
              plural(made.signals, "signal").c_str(), 1e-3 * static_cast<double>(made.file_bytes));
  tell_problem(record);
  return exit_passed;
}

// Prints all lines. False: interrupted, or the reader has stopped reading.
template <typename Lines>
bool pour(Lines& lines, LineOutput& output) {
  for (std::string line; lines.next(line);) {
    if (interrupted() || !output.put(line)) return false;
  }
  return true;
}

int log_cat(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  JsonLines lines(options.file, options.topics, span);
  LineOutput output("");
  const bool all = pour(lines, output);
  output.finish();
  if (interrupted()) return exit_interrupted;
  if (!all) return exit_passed;
  if (!lines.unknown_topics().empty()) (void)choose_topics(outline_of(options.file), lines.unknown_topics());  // throws
  if (lines.lines() == 0) require_overlap(outline_of(options.file), span);
  tell_problem(lines.reader());
  return exit_passed;
}

int log_observations(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  if (!options.out.empty()) require_free(options);
  std::vector<RecordedObservation> all = read_observations(options.file);
  std::erase_if(all, [&](const RecordedObservation& one) { return !span.holds(one.came_ns); });
  LineOutput output(options.out);
  for (const std::string& line : observation_lines(all)) {
    if (!output.put(line)) break;
  }
  output.finish();
  return exit_passed;
}

int log_csv(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  if (!options.out.empty()) require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, span);
  std::optional<std::int64_t> every_ns;
  if (options.every_s) every_ns = std::llround(*options.every_s * 1e9);
  CsvLines lines(options.file, choose_signals(record, options.signals), span, every_ns);
  LineOutput output(options.out);
  const bool all = pour(lines, output);
  if (interrupted()) return exit_interrupted;
  output.finish();
  if (all) tell_problem(record);
  return exit_passed;
}

constexpr std::size_t signals_max = 64;  // nobody can distinguish more lines
constexpr std::size_t sketch_columns = 72;

PlotFormat format_of(const std::string& file) {
  const std::string ending = std::filesystem::path(file).extension().string();
  if (ending == ".svg") return PlotFormat::svg;
  if (ending == ".png") return PlotFormat::png;
  refuse(file, "a plot's file ends with .svg or .png");
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

int log_plot(const LogOptions& options) {
  const TimeSpan span = span_of(options);
  const PlotFormat format = options.out.empty() ? PlotFormat::svg : format_of(options.out);
  if (!options.out.empty()) require_free(options);
  const RecordOutline record = outline_of(options.file);
  require_overlap(record, span);
  const std::vector<ChosenSignal> signals = choose_signals(record, options.signals);
  if (signals.size() > signals_max)
    refuse("these are " + std::to_string(signals.size()) + " signals; a plot of more than " +
           std::to_string(signals_max) + " cannot be read, choose fewer");
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

constexpr const char* signals_help = "Names, patterns (\"joint.*knee*\") or front parts (joint.l_knee) of signals";

CLI::App* verb(CLI::App& log, LogOptions& options, const char* name, const char* doc) {
  CLI::App* command = log.add_subcommand(name, doc);
  command->add_option("file", options.file, "Record (MCAP)")->required()->type_name("FILE");
  return command;
}

void add_span(CLI::App& verb, LogOptions& options) {
  verb.add_option("--from", options.from_s, "First second, in the record's time (default: its beginning)")
      ->type_name("S")
      ->check(any_number());
  verb.add_option("--to", options.to_s, "Last second, in the record's time (default: its end)")
      ->type_name("S")
      ->check(any_number());
}

void add_out(CLI::App& verb, LogOptions& options, const char* doc, const char* type) {
  verb.add_option("-o,--out", options.out, doc)->type_name(type);
  verb.add_flag("--force", options.force, "Overwrite that file if it exists");
}

void add_reading(CLI::App& log, LogOptions& options) {
  CLI::App* info = verb(log, options, "info", "The record's run and contents, and whether it is complete");
  info->add_flag("--json", options.json, "Print one JSON object instead of text");

  CLI::App* cat = verb(log, options, "cat", "Print each message as a line of JSON");
  cat->add_option("--topic", options.topics, "Print only this topic, such as /joint or transitions; may be repeated")
      ->type_name("TOPIC")
      ->allow_extra_args(false);
  add_span(*cat, options);

  CLI::App* csv = verb(log, options, "csv", "Print signals as a table with units, with all digits");
  csv->add_option("signals", options.signals, std::string(signals_help) + " (default: all)")->type_name("SIGNAL...");
  add_span(*csv, options);
  add_number(*csv, "--every", options.every_s, 1e-6, 1e6, "S", "Print a line every S seconds, with the newest values");
  add_out(*csv, options, "Write into a file (default: stdout)", "FILE");

  CLI::App* observations =
      verb(log, options, "observations", "Print what the robot observed, as a sequence for perception to feed again");
  add_span(*observations, options);
  add_out(*observations, options, "Write into a file (default: stdout)", "FILE");
}

void add_making(CLI::App& log, LogOptions& options) {
  CLI::App* plot = verb(log, options, "plot", "Draw signals over time, with states and faults");
  plot->add_option("signals", options.signals, signals_help)->required()->type_name("SIGNAL...");
  add_span(*plot, options);
  add_out(*plot, options, "Picture, by its ending SVG or PNG (default: a sketch in the terminal)", "FILE");

  CLI::App* diff = verb(log, options, "diff", "Report where two records differ, and by how much");
  diff->add_option("other", options.other, "The record that it is compared with")->required()->type_name("OTHER");
  add_number(*diff, "--tolerance", options.tolerance, 0.0, 1e300, "X",
             "Largest difference between numbers that count as equal (default: 0)");
  diff->add_flag("--json", options.json, "Print one JSON object instead of text");

  CLI::App* cut = verb(log, options, "cut", "Write a time span or some signals as a new record");
  add_span(*cut, options);
  cut->add_option("--signals", options.signals, std::string(signals_help) + "; once or more (default: all)")
      ->type_name("SIGNAL")
      ->allow_extra_args(false);
  cut->add_flag("--inputs", options.inputs, "Keep what went into the run, so that `kadans replay` repeats it");
  add_out(*cut, options, "The new record", "FILE");
  cut->get_option("--out")->required();
}

int run_log(const CommandLine& line, const LogOptions& options) {
  struct Verb {
    const char* name;
    int (*run)(const LogOptions&);
  };
  static constexpr std::array<Verb, 7> verbs{{{"info", log_info},
                                              {"cat", log_cat},
                                              {"csv", log_csv},
                                              {"observations", log_observations},
                                              {"plot", log_plot},
                                              {"diff", log_diff},
                                              {"cut", log_cut}}};
  catch_interrupts();  // a reader that stops reading is no error
  const CLI::App* log = line.app.get_subcommand("log");
  for (const Verb& verb : verbs) {
    if (log->got_subcommand(verb.name)) return verb.run(options);
  }
  return exit_usage;
}

}  // namespace

void add_log(CommandLine& line) {
  const auto [log, options] =
      line.add<LogOptions>("log", "Examine a record: info, cat, csv, observations, plot, diff, cut", run_log);
  log->require_subcommand(1);
  add_reading(*log, options);
  add_making(*log, options);
  log->footer(
      "Times are seconds of the record's own clock, as `log info` shows them.\n"
      "Exit codes: 0 done (diff: the same), 1 diff: not the same, 2 wrong usage or input.");
}

}  // namespace kadans
