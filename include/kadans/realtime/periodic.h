// The beat of a periodic task: grid points first_ns + k * period_ns.
//
// A beat is never caught up with. When the work of a beat is not done at the next grid point, or the system wakes the
// task a whole period late, the points that have passed are left out and counted, and the task goes on on the grid:
// there is always a wait between two beats, and a task that is too slow leaves time to the others. Nor does a beat
// follow one that woke late in less than half a period: what changed in a whole one would look as if it had changed in
// a moment. What the task is told is true: how many were left out, and how long ago the last beat was.
//
// A clock that does not advance over a wait gives a beat that `stands`: there is nothing to be done in it.
// One owner, the task's thread; the statistics may be read by any.
#pragma once

#include <cstdint>

#include "kadans/realtime/task_statistics.h"
#include "kadans/realtime/wait.h"

namespace kadans {

struct Beat {
  std::uint64_t number = 0;  // of the grid point; those left out are counted
  std::int64_t due_ns = 0;   // the grid point
  std::int64_t woke_ns = 0;
  double dt_s = 0;           // between this wake-up and the last; the period at first
  std::uint32_t missed = 0;  // left out before this one
  bool stands = false;       // the clock
};

class Periodic {
 public:
  // The wait must outlive it. period_ns > 0.
  Periodic(Wait& wait, std::int64_t period_ns, std::int64_t first_ns) noexcept
      : wait_(wait), period_ns_(period_ns), due_ns_(first_ns) {}

  // Plans the next beat, waits for it.
  Beat next() noexcept {
    (void)plan();
    return wake();
  }
  // The same in two steps: when the next beat is due, what was worked past left out; then the waiting.
  std::int64_t plan() noexcept;
  Beat wake() noexcept;
  // The work of the beat is done. Before the next next().
  void done() noexcept;

  const TaskStatistics& statistics() const noexcept { return statistics_; }

 private:
  void leave_out(std::int64_t periods) noexcept;
  void note_wake(Beat& beat, std::int64_t lateness_ns) noexcept;

  Wait& wait_;
  std::int64_t period_ns_;
  std::int64_t due_ns_;
  std::uint64_t number_ = 0;
  std::uint32_t missed_ = 0;  // since the last beat
  std::int64_t woke_ns_ = 0;
  bool running_ = false;
  TaskStatistics statistics_;
};

}  // namespace kadans
