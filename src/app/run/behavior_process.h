// Runs the behaviors of a live run in a process of their own (script/process), and the decisions over them in another.
// The program starts itself with a hidden command, so the new process is empty and reads the same files. The same files
// give the same numbers of parameters and set-points: the process makes the control objects, for their names and
// ranges, but neither plant nor engines.
#pragma once

#include <memory>

#include "app/commands.h"
#include "script/process/process_host.h"

namespace kadans {

// The scenario that corresponds to a live run.
ScenarioConfig live_scenario(const RunOptions& options);

// Starts the process. It writes mistakes that it finds to standard error. Throws std::system_error.
std::unique_ptr<ProcessHost> start_behavior_process(const RunOptions& options, BehaviorLog& log);
// The same for the decisions, which are ticked once in this period.
std::unique_ptr<ProcessHost> start_decision_process(const RunOptions& options, BehaviorLog& log,
                                                    std::int64_t period_ns);

}  // namespace kadans
