#include "record_options.h"

#include <CLI/CLI.hpp>

#include "option_checks.h"
#include "services.h"

namespace kadans {

void add_record_options(CLI::App& command, RecordOptions& options) {
  command
      .add_option("--signals", options.signals,
                  "Record only these signals: \"joint.*, base.*@100\" (default: the robot's choice, else all)")
      ->type_name("PATTERN[@HZ],...");
  add_number(command, "--flight", options.flight_s, 0.0, 600.0, "S",
             "Keep the last S seconds in memory, and write them when a fault latches; 0: none (default: the "
             "robot's flight_s in a run on the wall clock, else 0)");
}

RecordPlan record_plan(const Assembly& assembly, const RecordOptions& options, bool flies) {
  const RecordConfig& config = assembly.robot().record;
  const Catalog& catalog = assembly.catalog();
  const SignalChoice choice =
      options.signals.empty() ? config.signals : parse_signal_choice(options.signals, "--signals");
  RecordPlan plan;
  const double control_period_s = assembly.robot().engine.control_period_s;
  plan.settings.every_ticks = ticks_between(choice, catalog.signals, control_period_s);
  plan.settings.precision = config.single_precision ? Precision::single : Precision::full;
  plan.settings.subjects = viewer_subjects(assembly);
  plan.settings.parameters = &catalog.parameters;
  plan.flight = {.kept_s = options.flight_s.value_or(flies ? config.flight_s : 0),
                 .bytes = static_cast<std::size_t>(config.flight_MB * 1e6)};
  if (plan.flight.kept_s > 0) plan.flight.every_ticks = ticks_between({}, catalog.signals, control_period_s);
  plan.file_bytes = static_cast<std::uint64_t>(config.file_MB * 1e6);
  plan.folder_bytes = static_cast<std::uint64_t>(options.folder_MB.value_or(config.folder_MB) * 1e6);
  return plan;
}

void add_report_options(CLI::App& command, ReportOptions& place, const char* what, const char* film) {
  place.film = film;
  CLI::Option* folder = command.add_option("--report", place.folder, what)->type_name("FOLDER");
  command.add_option("--film", place.film, std::string("With --report: pictures of the robot (default: ") + film + ")")
      ->check(CLI::IsMember({"always", "failed", "never"}))
      ->needs(folder);
}

}  // namespace kadans
