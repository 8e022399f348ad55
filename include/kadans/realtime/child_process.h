// A program that this process runs beside itself, and with which it shares memory and a doorbell.
//
// It is spawned, not forked: a fork of a running real-time process would copy the page tables of all its locked memory
// and then cost each of its threads a page fault for every page that it writes. A spawn lends the memory until the new
// program runs, and copies nothing.
//
// The program starts as a normal process. It has no signal handlers. Signals that are meant for this process are
// blocked (a terminal's Ctrl-C and a service manager's SIGTERM go to the whole group). It sets its priority and CPU
// itself, once it is ready. It has the standard output and standard error of this process, and no other open file.
//
// Threads: one at a time.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

#include "kadans/realtime/doorbell.h"
#include "kadans/realtime/shared_memory.h"

namespace kadans {

// The descriptors at which the program finds its ends.
inline constexpr int child_doorbell_descriptor = 3, child_memory_descriptor = 4;

class ChildProcess {
 public:
  // The program's path and its arguments, its name first. Throws std::system_error.
  ChildProcess(const std::string& program, const std::vector<std::string>& arguments, const SharedMemory& memory)
      : ChildProcess(start(program, arguments, memory)) {}
  ~ChildProcess();  // kills and reaps it
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  pid_t pid() const noexcept { return pid_; }
  Doorbell& bell() noexcept { return bell_; }

  void kill() const noexcept;
  // Closes the doorbell, waits a moment for the process to end by itself, kills it if it does not, and reaps it. Says
  // how it ended: "exit code 2", "signal 11 (Segmentation fault)".
  std::string end() noexcept;
  bool exited(int code) const noexcept;  // after end(): whether it ended by itself, with this code

 private:
  struct Started {
    Doorbell bell;
    pid_t pid;
  };
  static Started start(const std::string& program, std::vector<std::string> arguments, const SharedMemory& memory);
  explicit ChildProcess(Started started) noexcept : bell_(std::move(started.bell)), pid_(started.pid) {}
  bool reap(int tries) noexcept;

  Doorbell bell_;
  pid_t pid_ = -1;
  bool reaped_ = false;
  int status_ = 0;
};

// Called by the program itself: from now on it dies when the thread that started it dies.
void die_with_parent() noexcept;

}  // namespace kadans
