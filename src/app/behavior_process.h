// Behaviors of a live run in a process of their own (script/process): the program starts itself with a command of its
// own, so that the other side is an empty process that reads the same files. The same files, the same numbers: it
// builds the control objects too, for their names and ranges, but neither plant nor engines.
#pragma once

#include <memory>

#include "commands.h"
#include "kadans/script/process/process_host.h"

namespace kadans {

// The scenario that a live run is.
ScenarioConfig live_scenario(const RunOptions& options);

// Starts it; whatever it finds wrong it says on standard error. Throws std::system_error.
std::unique_ptr<ProcessHost> start_behavior_process(const RunOptions& options, BehaviorLog& log);

}  // namespace kadans
