// Makes the run that is debugged: a simulation, or the repetition of a record.
#pragma once

#include <memory>
#include <string>

#include "app/run/run_choices.h"
#include "app/sim/input_files.h"
#include "run_channel.h"

namespace kadans {

struct DebugLaunch {
  std::string file;    // scenario or record
  RunChoices choices;  // for a scenario
  bool from_record = false, allow_plugins = false;
};

struct DebugSubject {
  DebugLaunch launch;
  bool recorded = false;
  RunInputs inputs{};                          // of a record
  std::unique_ptr<UnpackedInputs> unpacked{};  // when the record's files are used; its owner is the debugger's process
};
// Throws InputError for a record that cannot be run again.
DebugSubject debug_subject(DebugLaunch launch);

// In a process of its own, which never comes back. It tells "ready" or, with why, "failed".
[[noreturn]] void debug_in_this_process(RunChannel channel, const DebugSubject& subject);

}  // namespace kadans
