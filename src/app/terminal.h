// What the program may do on the streams it was given, and what it says there.
#pragma once

#include <functional>
#include <string>

#include "kadans/signal/input_error.h"

namespace kadans {

enum ExitCode : int { exit_passed = 0, exit_failed = 1, exit_usage = 2, exit_internal = 3, exit_interrupted = 130 };

bool stdout_takes_color();  // a terminal, and NO_COLOR is not set
bool stderr_is_terminal();

// One line a problem on stderr: "error: file:line:column: what is wrong".
void print_problems(const InputError& error);
void print_error(const std::string& message);

// All that a program does, and what it ends with: the code that `run` gives, or that of what it throws, which is told
// on stderr. Never 0 when stdout did not take all that was printed on it, a full disk. Throws nothing.
int ended_well(const std::function<int()>& run);

// From now on SIGINT and SIGTERM set a flag instead of ending the program, and end scripts that go on nevertheless.
void catch_interrupts();
bool interrupted() noexcept;

}  // namespace kadans
