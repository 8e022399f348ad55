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
  verb.add_option("--from", options.from_s, "From this second of the record's time (default: its beginning)")
      ->type_name("S")
      ->check(any_number());
  verb.add_option("--to", options.to_s, "To this second (default: its end)")->type_name("S")->check(any_number());
}

void add_out(CLI::App& verb, LogOptions& options, const char* doc, const char* type) {
  verb.add_option("-o,--out", options.out, doc)->type_name(type);
  verb.add_flag("--force", options.force, "Replace that file if it is there");
}

void add_reading(CLI::App& log, LogOptions& options) {
  CLI::App* info = verb(log, options, "info", "What run it is of, what it holds, and whether it is whole");
  info->add_flag("--json", options.json, "Print one JSON object instead of text");

  CLI::App* cat = verb(log, options, "cat", "Every message as a line of JSON");
  cat->add_option("--topic", options.topics, "Only this one, such as /joint or transitions; once or more")
      ->type_name("TOPIC")
      ->allow_extra_args(false);
  add_span(*cat, options);

  CLI::App* csv = verb(log, options, "csv", "Signals as a table with their units, every digit of them");
  csv->add_option("signals", options.signals, std::string(signals_help) + " (default: all)")->type_name("SIGNAL...");
  add_span(*csv, options);
  csv->add_option("--every", options.every_s, "A line each so many seconds, with the newest values")
      ->type_name("S")
      ->check(number_within(1e-6, 1e6));
  add_out(*csv, options, "Into a file (default: onto stdout)", "FILE");
}

void add_making(CLI::App& log, LogOptions& options) {
  CLI::App* plot = verb(log, options, "plot", "Draw signals over time, with states and faults");
  plot->add_option("signals", options.signals, signals_help)->required()->type_name("SIGNAL...");
  add_span(*plot, options);
  add_out(*plot, options, "Picture, by its ending SVG or PNG (default: a sketch in the terminal)", "FILE");

  CLI::App* diff = verb(log, options, "diff", "Where two records part, and by how much");
  diff->add_option("other", options.other, "The record that it is compared with")->required()->type_name("OTHER");
  diff->add_option("--tolerance", options.tolerance, "Numbers that are no further apart are the same (default: 0)")
      ->type_name("X")
      ->check(number_within(0.0, 1e300));
  diff->add_flag("--json", options.json, "Print one JSON object instead of text");

  CLI::App* cut = verb(log, options, "cut", "A stretch of it, or some of its signals, as a record of its own");
  add_span(*cut, options);
  cut->add_option("--signals", options.signals, std::string(signals_help) + "; once or more (default: all)")
      ->type_name("SIGNAL")
      ->allow_extra_args(false);
  add_out(*cut, options, "The new record", "FILE");
  cut->get_option("--out")->required();
}

}  // namespace

void add_log(CLI::App& app, LogOptions& options) {
  CLI::App* log = app.add_subcommand("log", "Look into a record: info, cat, csv, plot, diff, cut");
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
