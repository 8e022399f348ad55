// The options of the command line for records, and the plan that follows from them and from the robot's configuration.
#pragma once

#include <optional>
#include <string>

#include "app/assembly/assembly.h"
#include "remote/instance/record_side.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct RecordOptions {
  std::string signals;              // "joint.*, base.*@100"; "": those of the robot's configuration
  std::optional<double> flight_s;   // time span that the flight recorder keeps
  std::optional<double> folder_MB;  // room for the records that nobody named
};
void add_record_options(CLI::App& command, RecordOptions& options);

// `flies`: there is a flight recorder unless an option says otherwise. Throws InputError when the choice of signals is
// wrong.
RecordPlan record_plan(const Assembly& assembly, const RecordOptions& options, bool flies);

// --report: the folder for the pages of runs, and when they get pictures.
struct ReportOptions {
  std::string folder;  // "": no report
  std::string film;    // always, failed, never

  bool wanted() const noexcept { return !folder.empty(); }
};
void add_report_options(CLI::App& command, ReportOptions& place, const char* what, const char* film);

}  // namespace kadans
