// What the commands that run in real time ask of the machine before they start.
#pragma once

namespace kadans {

// Says what is missing. False when the command must not go on without: it is, and `soft` is not set.
bool rights_suffice(int priority, bool soft);

// Starts this program anew, unless that was done, so that all functions of its libraries are bound before main(): else
// a real-time thread that is the first to call one has it looked up, which takes long and touches memory all over.
// Returns when they are bound, or cannot be, which is told. Before any thread is started.
void bind_all_functions(char** argv);

// All memory stays where it is. Without the right to it, which has been told, nothing happens.
void lock_program(bool with_model) noexcept;

}  // namespace kadans
