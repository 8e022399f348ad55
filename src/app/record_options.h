// What the command line says of records, and what follows from it and the robot's configuration.
#pragma once

#include <optional>
#include <string>

#include "kadans/app/assembly.h"
#include "kadans/remote/record_side.h"

namespace CLI {  // NOLINT(readability-identifier-naming): its name
class App;
}

namespace kadans {

struct RecordOptions {
  std::string signals;             // "joint.*, base.*@100"; "" = as the robot's configuration says
  std::optional<double> flight_s;  // what the flight recorder keeps
};
void add_record_options(CLI::App& command, RecordOptions& options);

// `flies`: there is a flight recorder unless told otherwise. Throws InputError when a choice of signals is wrong.
RecordPlan record_plan(const Assembly& assembly, const RecordOptions& options, bool flies);

}  // namespace kadans
