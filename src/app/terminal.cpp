#include "terminal.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include "kadans/script/budget.h"

namespace kadans {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void note_interrupt(int) {
  interrupt_flag = 1;
  interrupt_scripts();
}

bool color_wanted() {
  const char* no_color = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe): before any thread is started
  return no_color == nullptr || *no_color == '\0';
}

}  // namespace

bool stdout_takes_color() { return color_wanted() && isatty(STDOUT_FILENO) == 1; }
bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

void print_error(const std::string& message) {
  const bool color = color_wanted() && stderr_is_terminal();
  std::fprintf(stderr, "%serror:%s %s\n", color ? "\033[31;1m" : "", color ? "\033[0m" : "", message.c_str());
}

void print_problems(const InputError& error) {
  for (const InputProblem& problem : error.problems()) print_error(problem.text());
}

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() noexcept { return interrupt_flag != 0; }

}  // namespace kadans
