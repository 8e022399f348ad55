// The beat of a periodic task, and how well the task keeps it.
#pragma once

#include <cstdint>

#include "engine/tick/tick_statistics.h"
#include "kadans/exchange/one_writer.h"
#include "wait.h"

namespace kadans {

// How well a periodic task keeps its time. Written by the task alone, without locks; any thread may read while it runs:
// each number is whole, but not all are of the same beat.
//
//   lateness   wake-up after the time it was due
//   jitter     |interval - period| against the wake-up before: the definition of the timing test of 2008
//   execution  from the wake-up to the end of the work
struct TaskStatistics {
  TickStatistics lateness, jitter, execution;
  Count overruns;    // the work was not done when the next beat was due
  Count late_wakes;  // the system woke the task a whole period late, or later
  Count missed;      // beats left out for either reason
};

// The beat of a periodic task: grid points first_ns + k * period_ns.
//
// A missed beat is never made up for. When the work of a beat is not done at the next grid point, or the system wakes
// the task a whole period late, the points that have passed are left out and counted, and the task continues on the
// grid. So there is always a wait between two beats, and a task that is too slow leaves time to the others. After a
// late wake-up the next beat does not come in less than half a period: else a change during a whole period would look
// like a change in a moment. The task is told how many beats were left out, and how long ago the last one really was.
//
// When the clock does not advance over a wait, the beat `stands`: the task has nothing to do in it. One owner, the
// task's thread; any thread may read the statistics.
struct Beat {
  std::uint64_t number = 0;  // of the grid point; those left out are counted
  std::int64_t due_ns = 0;   // the grid point
  std::int64_t woke_ns = 0;
  double dt_s = 0;           // between this wake-up and the last; the period at first
  std::uint32_t missed = 0;  // beats left out before this one
  bool stands = false;       // the clock did not advance
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
  // The same in two steps. plan() leaves out the points that have passed and returns the time of the next beat; wake()
  // waits for it.
  std::int64_t plan() noexcept;
  Beat wake() noexcept;
  // To be called when the work of the beat is done, before the next next().
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
