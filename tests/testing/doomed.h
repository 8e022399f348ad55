// Runs something that may abort in a child process, and tells how the child ended and what it wrote to stderr.
#pragma once

#include <array>
#include <csignal>
#include <iostream>
#include <string>

#include <doctest/doctest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace kadans::test {

struct Ending {
  bool aborted = false;
  int exit_code = -1;  // when it did not end by a signal
  std::string words;
  bool says(const std::string& text) const { return words.find(text) != std::string::npos; }
};

template <typename Act>
Ending run_in_child(Act act) {
  std::array<int, 2> ends{};
  REQUIRE(pipe(ends.data()) == 0);
  std::cout.flush();  // or the child might write it once more
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    close(ends[0]);
    close(ends[1]);
    std::signal(SIGABRT, SIG_DFL);  // not the test framework's, which would tell of a crashed test
    prctl(PR_SET_DUMPABLE, 0);      // no core file
    act();
    _exit(0);
  }
  close(ends[1]);
  Ending ending;
  std::array<char, 4096> piece;
  for (ssize_t size = 0; (size = read(ends[0], piece.data(), piece.size())) > 0;) {
    ending.words.append(piece.data(), static_cast<std::size_t>(size));
  }
  close(ends[0]);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  ending.aborted = WIFSIGNALED(status) && WTERMSIG(status) == SIGABRT;
  if (WIFEXITED(status)) ending.exit_code = WEXITSTATUS(status);
  return ending;
}

// Keeps the optimiser from leaving out an allocation whose block nobody uses.
inline void keep(const volatile void* block) { asm volatile("" : : "g"(block) : "memory"); }

}  // namespace kadans::test
