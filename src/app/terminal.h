// The program's standard streams, its messages and exit codes, and interrupts.
#pragma once

#include <functional>
#include <string>

#include "kadans/signal/input_error.h"

namespace kadans {

enum ExitCode : int { exit_passed = 0, exit_failed = 1, exit_usage = 2, exit_internal = 3, exit_interrupted = 130 };

bool stdout_takes_color();  // stdout is a terminal, and NO_COLOR is not set
bool stderr_is_terminal();

// Prints one line for each problem on stderr: "error: file:line:column: what is wrong".
void print_problems(const InputError& error);
void print_error(const std::string& message);
void print_line(const std::string& text);  // on stderr
// On stdout, where no text from a script or a program elsewhere steers the terminal.
void print_text(const std::string& text);

// Calls `run` and returns the exit code of the program: the code that `run` returns, or the code for its exception,
// which is printed on stderr. The code is never 0 when output to stdout was lost, for example on a full disk. Throws
// nothing.
int ended_well(const std::function<int()>& run);

// From now on SIGINT, SIGTERM and SIGHUP (a closed terminal) set a flag instead of ending the program; running scripts
// are then stopped after a moment. SIGPIPE and SIGXFSZ are ignored.
void catch_interrupts();
bool interrupted() noexcept;

}  // namespace kadans
