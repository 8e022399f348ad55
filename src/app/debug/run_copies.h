// The processes of the run that is debugged, as the debugger sees them: copies that wait, each at its moment, thinned
// to a bound of memory. The farther a copy is from where somebody looks, the farther it may be from its neighbours.
#pragma once

#include <cstddef>
#include <vector>

#include <sys/types.h>

#include "run_channel.h"

namespace kadans {

// A process of the run that waits for orders. It ends when it is dropped.
struct RunCopy {
  RunChannel channel;
  pid_t pid = -1;
  RunPosition at;
  Json where;           // what the run tells of its moment
  bool branch = false;  // the run became another one here: it is kept

  bool there() const noexcept { return channel.open(); }
};

// Another copy of a process that waits. Throws std::runtime_error when the system makes none.
RunCopy copy_of(const RunCopy& copy);
// Takes the copy that a message of the run brings; false: it brings none.
[[nodiscard]] bool take_copy(const Json& message, RunChannel& end, RunCopy& copy);

class RunCopies {
 public:
  explicit RunCopies(double memory_MB) noexcept : memory_bytes_(memory_MB * 1e6) {}

  // `near`: where somebody looks. A copy beside another one is dropped.
  void add(RunCopy copy, const RunPosition& near);
  // The last one before this moment, or also at it; size(): there is none.
  std::size_t last_before(const RunPosition& at, bool or_at) const noexcept;
  // The next branch behind this moment; nullptr: there is none.
  const RunCopy* branch_behind(const RunPosition& at) const noexcept;
  void drop_behind(const RunPosition& at);
  void clear() { all_.clear(); }
  std::size_t size() const noexcept { return all_.size(); }
  const RunCopy& operator[](std::size_t index) const { return all_[index]; }

 private:
  void thin(const RunPosition& near);

  double memory_bytes_;
  std::size_t most_ = 64, added_ = 0;
  std::vector<RunCopy> all_;  // rising
};

}  // namespace kadans
