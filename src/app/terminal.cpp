#include "terminal.h"

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <system_error>

#include <unistd.h>

#include "engine/behavior_log.h"
#include "script/lua/budget.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

// Whoever asks a third time does not want to wait for what hangs.
void note_interrupt(int) {
  static volatile std::sig_atomic_t asked = 0;
  asked = asked + 1;
  if (asked >= 3) _exit(exit_interrupted);
  interrupt_flag = 1;
  interrupt_scripts();
}

bool color_wanted() {
  const char* no_color = std::getenv("NO_COLOR");  // NOLINT(concurrency-mt-unsafe): before any thread is started
  return no_color == nullptr || *no_color == '\0';
}

// Returns `code`, or another one when output to stdout was lost.
int delivered(int code) {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return code;
  if (errno == EPIPE) return code;  // the reader has stopped reading
  const std::string why = errno == 0 ? std::string() : ": " + std::generic_category().message(errno);
  print_error("stdout: not all of the results could be written" + why);
  return code == exit_passed ? exit_usage : code;
}

}  // namespace

bool stdout_takes_color() { return color_wanted() && isatty(STDOUT_FILENO) == 1; }
bool stderr_is_terminal() { return isatty(STDERR_FILENO) == 1; }

void print_error(const std::string& message) {
  program_log().message(Line::no_time, BehaviorLog::Severity::error, "", message);
}

void print_line(const std::string& text) {
  program_log().message(Line::no_time, BehaviorLog::Severity::info, "", text);
}

void print_text(const std::string& text) { std::fputs(shown_text(text).c_str(), stdout); }

void print_problems(const InputError& error) {
  for (const InputProblem& problem : error.problems()) print_error(problem.text());
}

int ended_well(const std::function<int()>& run) {
  int code = exit_internal;
  try {
    code = run();
  } catch (const InputError& error) {
    print_problems(error);
    code = exit_usage;
  } catch (const std::filesystem::filesystem_error& error) {  // a path that the user named
    print_error(error.path1().string() + ": " + error.code().message());
    code = exit_usage;
  } catch (const std::exception& error) {
    print_error(std::string("internal: ") + error.what());
  }
  return delivered(code);
}

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  struct sigaction before = {};
  if (sigaction(SIGHUP, nullptr, &before) == 0 && before.sa_handler != SIG_IGN)  // nohup ignores it
    sigaction(SIGHUP, &action, nullptr);
  action.sa_handler = SIG_IGN;  // then writing fails, which is reported
  sigaction(SIGPIPE, &action, nullptr);
  sigaction(SIGXFSZ, &action, nullptr);
}

bool interrupted() noexcept { return interrupt_flag != 0; }

}  // namespace kadans
