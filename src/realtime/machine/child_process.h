// What this process starts: a program, or a copy of itself. Nothing else of Kadans starts any.
//
// A program is spawned, not forked: a fork of a running real-time process would copy the page tables of all its locked
// memory and then cost each of its threads a page fault for every page that it writes. A spawn lends the memory until
// the new program runs, and copies nothing.
//
// The program starts as a normal process. It handles no signals, and blocks none unless that is asked for. It has the
// normal scheduling class, and sets its priority and CPU itself, once it is ready. It has no open file but those that
// it is given. When this process ignores the hang-up of its terminal (nohup), so does the program.
//
// Threads: one at a time for each object.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "shared_memory.h"

namespace kadans {

inline constexpr int no_file = -1;

struct ProgramStart {
  std::vector<std::string> words;     // its name and its arguments
  std::string program;                // its path; "": its name, looked up in PATH
  std::vector<int> files{0, 1, 2};    // our descriptors, which it gets as 0, 1, 2 ...; no_file: /dev/null
  bool own_group = false;             // of processes: Ctrl-C does not reach it; kill() also ends what it has started
  bool blocks_group_signals = false;  // Ctrl-C of a terminal and SIGTERM of a service manager go to a whole group
};

class ChildProcess {
 public:
  explicit ChildProcess(const ProgramStart& start);  // throws std::system_error
  // Copies this process, which must have one thread. Returns nullopt in the copy. Throws std::system_error.
  static std::optional<ChildProcess> copy();
  // The same, for a copy that ends by itself and for which nobody waits: whoever calls it ignores SIGCHLD. Returns the
  // copy's number, 0 in the copy, -1: the system refuses.
  static pid_t copy_alone() noexcept;
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess() { stop(); }

  // Waits until one of these processes has ended, at most `most_ms`; < 0: without a limit. All must still run. A signal
  // ends the wait early.
  static void wait_for_one(std::span<const ChildProcess* const> running, int most_ms);

  pid_t pid() const noexcept { return pid_; }
  bool ended() noexcept { return reap(false); }
  void wait() noexcept;  // until it has ended
  void kill() const noexcept;
  void stop() noexcept;  // kills it and waits; not in a copy of the process that started it
  // Waits a moment for the process to end by itself, and kills it if it does not. Never waits long. Returns how it
  // ended: "exit code 2", "signal 11 (Segmentation fault)".
  std::string end() noexcept;
  int exit_code() const noexcept;  // -1: it runs, a signal ended it, or nobody can tell
  int signal() const noexcept;     // the signal that ended it, or 0

 private:
  ChildProcess(pid_t pid, bool own_group) noexcept;
  bool reap(bool waits) noexcept;
  bool ends_soon(int tries) noexcept;
  void forget() noexcept;

  pid_t pid_, owner_;
  bool own_group_, running_ = true;
  OwnedDescriptor end_;  // that can be read once the process has ended; none: the system has none
  std::optional<int> status_;
};

// Called by the program itself: from now on it dies when the thread that started it dies.
void die_with_parent() noexcept;

// A nameless file in memory, for what a child reads or writes.
class MemoryFile {
 public:
  explicit MemoryFile(std::string_view text = {});  // throws std::system_error

  int descriptor() const noexcept { return descriptor_.number(); }
  std::string text() const;  // all that is in it

 private:
  OwnedDescriptor descriptor_;
};

struct ProgramOutput {
  int exit_code = -1;
  std::string out, err;
};
// Runs a program to its end, with this text to read. Throws std::system_error when it cannot be started.
ProgramOutput run_program(std::vector<std::string> words, std::string_view input = {});

// The descriptors at which a program finds its ends of what it shares.
inline constexpr int child_doorbell_descriptor = 3, child_memory_descriptor = 4;

// A program that this process runs beside itself, and with which it shares memory and a doorbell. It has the standard
// input, output and error of this process, and blocks signals that are meant for its group.
class PartnerProcess {
 public:
  // The program's path, its name and arguments. Throws std::system_error.
  PartnerProcess(const std::string& program, const std::vector<std::string>& words, const SharedMemory& memory)
      : PartnerProcess(program, words, memory, Doorbell::make_pair()) {}
  ~PartnerProcess() { (void)end(); }

  pid_t pid() const noexcept { return process_.pid(); }
  Doorbell& bell() noexcept { return bell_; }
  void kill() const noexcept { process_.kill(); }
  std::string end() noexcept;  // lets go of the doorbell; else as of every child

 private:
  PartnerProcess(const std::string& program, const std::vector<std::string>& words, const SharedMemory& memory,
                 std::pair<Doorbell, Doorbell> ends);

  Doorbell bell_;
  ChildProcess process_;
};

}  // namespace kadans
