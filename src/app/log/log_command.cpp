#include "log_command.h"

#include <array>
#include <csignal>
#include <functional>

#include <CLI/CLI.hpp>

#include "app/option_checks.h"
#include "app/terminal.h"
#include "log_verbs.h"

namespace kadans {
namespace {

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
  csv->add_option("--every", options.every_s, "Print a line every S seconds, with the newest values")
      ->type_name("S")
      ->check(number_within(1e-6, 1e6));
  add_out(*csv, options, "Write into a file (default: stdout)", "FILE");
}

void add_making(CLI::App& log, LogOptions& options) {
  CLI::App* plot = verb(log, options, "plot", "Draw signals over time, with states and faults");
  plot->add_option("signals", options.signals, signals_help)->required()->type_name("SIGNAL...");
  add_span(*plot, options);
  add_out(*plot, options, "Picture, by its ending SVG or PNG (default: a sketch in the terminal)", "FILE");

  CLI::App* diff = verb(log, options, "diff", "Report where two records differ, and by how much");
  diff->add_option("other", options.other, "The record that it is compared with")->required()->type_name("OTHER");
  diff->add_option("--tolerance", options.tolerance,
                   "Largest difference between numbers that count as equal (default: 0)")
      ->type_name("X")
      ->check(number_within(0.0, 1e300));
  diff->add_flag("--json", options.json, "Print one JSON object instead of text");

  CLI::App* cut = verb(log, options, "cut", "Write a time span or some signals as a new record");
  add_span(*cut, options);
  cut->add_option("--signals", options.signals, std::string(signals_help) + "; once or more (default: all)")
      ->type_name("SIGNAL")
      ->allow_extra_args(false);
  add_out(*cut, options, "The new record", "FILE");
  cut->get_option("--out")->required();
}

}  // namespace

void add_log(CLI::App& app, LogOptions& options) {
  CLI::App* log = app.add_subcommand("log", "Examine a record: info, cat, csv, plot, diff, cut");
  log->require_subcommand(1);
  add_reading(*log, options);
  add_making(*log, options);
  log->footer(
      "Times are seconds of the record's own clock, as `log info` shows them.\n"
      "Exit codes: 0 done (diff: the same), 1 diff: not the same, 2 wrong usage or input.");
}

int run_log(const CLI::App& app, const LogOptions& options) {
  struct Verb {
    const char* name;
    int (*run)(const LogOptions&);
  };
  static constexpr std::array<Verb, 6> verbs{{{"info", log_info},
                                              {"cat", log_cat},
                                              {"csv", log_csv},
                                              {"plot", log_plot},
                                              {"diff", log_diff},
                                              {"cut", log_cut}}};
  (void)std::signal(SIGPIPE, SIG_IGN);  // a reader that stops reading is no error
  catch_interrupts();
  const CLI::App* log = app.get_subcommand("log");
  for (const Verb& verb : verbs) {
    if (log->got_subcommand(verb.name)) return verb.run(options);
  }
  return exit_usage;
}

}  // namespace kadans
