// The watchdog for the end of the process, in processes that it may end.
#include "app/run/last_resort.h"

#include <array>
#include <csignal>
#include <string>

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace kadans;

namespace {

constexpr std::int64_t hour_ns = 3'600'000'000'000;

struct Ended {
  int exit_code = -1;
  std::string err;
};

// Calls `part` in a process of its own, which ends with code 3 if nothing ended it before.
Ended in_a_process(void (*part)()) {
  std::array<int, 2> ends{};
  REQUIRE(pipe2(ends.data(), O_CLOEXEC) == 0);
  const pid_t child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(ends[1], STDERR_FILENO);
    part();
    _exit(3);
  }
  close(ends[1]);
  Ended ended;
  std::array<char, 256> bytes{};
  for (ssize_t count = 0; (count = ::read(ends[0], bytes.data(), bytes.size())) > 0;)
    ended.err.append(bytes.data(), static_cast<std::size_t>(count));
  close(ends[0]);
  int status = -1;
  REQUIRE(waitpid(child, &status, 0) == child);
  if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
  return ended;
}

[[noreturn]] void hang() {
  for (;;) ::pause();
}

}  // namespace

TEST_CASE("LastResort ends a process whose part hangs, with its exit code, and says which part") {
  const Ended ended = in_a_process([] {
    LastResort last_resort(0, 7);
    last_resort.expect("a test's part", 0);
    hang();
  });
  CHECK(ended.exit_code == 7);
  CHECK(ended.err == "error: a test's part hangs; the run ends without it\n");
}

TEST_CASE("LastResort judges by the newest expectation") {
  const Ended ended = in_a_process([] {
    LastResort last_resort(0, 7);
    last_resort.expect("an earlier part", hour_ns);
    last_resort.expect("a later part", 0);
    hang();
  });
  CHECK(ended.exit_code == 7);
  CHECK(ended.err == "error: a later part hangs; the run ends without it\n");
}

TEST_CASE("A LastResort that is destroyed in time ends nothing, whether it expected something or not") {
  const Ended ended = in_a_process([] {
    const LastResort unused(0, 7);
    LastResort last_resort(0, 7);
    last_resort.expect("a test's part", hour_ns);
  });
  CHECK(ended.exit_code == 3);
  CHECK(ended.err.empty());
}
