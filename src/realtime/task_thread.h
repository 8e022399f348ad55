// A periodic task on a thread of its own, with a period, a priority, a CPU and a stack; its beat, and how well it is
// kept.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>

#include <pthread.h>

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

// A periodic task on a thread of its own, with a period, a priority, a CPU and a stack.
//
// The thread blocks all signals, so that they disturb only the thread that started it. It touches its stack before the
// first beat (of a large stack 256 kB). It has its scheduling class from its first instruction: SCHED_FIFO with a
// priority above 0, the normal one with 0. If the system refuses the priority or the CPU, the task runs without it;
// refused_priority() and refused_cpu() say so.
//
// pthreads, not std::thread: Xenomai replaces the pthread calls when the program is linked, not those inside libstdc++.
// Threads: start, stop, join by the owner; the others by any.
class Task {
 public:
  virtual ~Task() = default;
  // The task's thread. False: the task is over. An exception ends it too.
  virtual bool beat(const Beat& beat) = 0;
  // The task's thread, in the last prepare_ns before a beat is due, as often as there is time.
  virtual void prepare() noexcept {}
};

struct TaskSettings {
  std::string name;  // at most 15 characters, shown by ps and top
  std::int64_t period_ns = 1'000'000;
  std::int64_t first_ns = 0;    // the first beat, on the clock of its wait
  std::int64_t prepare_ns = 0;  // 0: not at all
  int priority = 0;             // of SCHED_FIFO, 1..99; 0: not a real-time thread
  int cpu = -1;                 // -1: any
  std::size_t stack_bytes = std::size_t{256} * 1024;
};

class TaskThread {
 public:
  // After this many wake-ups in a row without an advance of the clock the task gives up.
  static constexpr int standing_max = 100;

  // Task and wait must outlive it.
  TaskThread(TaskSettings settings, Task& task, Wait& wait);
  ~TaskThread();  // stops and joins
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  // Throws std::system_error when there can be no thread.
  void start();
  void stop() noexcept { stop_.store(true, std::memory_order_relaxed); }  // after the present beat
  void join() noexcept;
  // Joins, but waits at most until a time on CLOCK_MONOTONIC. False: the thread still runs, and neither this object nor
  // what the task works on may be destroyed before a join.
  [[nodiscard]] bool join_until(std::int64_t monotonic_ns) noexcept;

  const TaskSettings& settings() const noexcept { return settings_; }
  const TaskStatistics& statistics() const noexcept { return periodic_.statistics(); }
  // How long each prepare() took.
  const TickStatistics& preparation() const noexcept { return preparation_; }
  bool begun() const noexcept { return begun_.load(std::memory_order_relaxed); }  // it got its CPU
  bool over() const noexcept { return over_.load(std::memory_order_acquire); }
  // Once it is over: why it ended before its time; "" when it did not.
  const char* failure() const noexcept { return over() ? failure_.data() : ""; }
  // Once it beats: the errno with which the system refused; 0 when it did not.
  int refused_priority() const noexcept { return refused_priority_.load(std::memory_order_relaxed); }
  int refused_cpu() const noexcept { return refused_cpu_.load(std::memory_order_relaxed); }
  // CPU time that it used so far; 0 before start().
  std::int64_t cpu_time_ns() const noexcept;
  // Once it is over: page faults in its beats, those of the first `warm_up_beats` left out.
  std::uint64_t page_faults() const noexcept { return over() ? page_faults_ : 0; }

 private:
  static constexpr std::uint64_t warm_up_beats = 100;

  void run() noexcept;
  void loop();
  void prepare_until(std::int64_t due_ns) noexcept;
  void move_to_cpu() noexcept;
  void fail(const char* why) noexcept;

  TaskSettings settings_;
  Task& task_;
  Wait& wait_;
  Periodic periodic_;
  TickStatistics preparation_;
  pthread_t thread_{};
  bool joinable_ = false;
  std::atomic<bool> stop_{false}, begun_{false}, over_{false};
  std::atomic<int> refused_priority_{0}, refused_cpu_{0};
  std::atomic<std::int64_t> cpu_time_at_end_ns_{0};
  std::array<char, 256> failure_{};
  std::uint64_t page_faults_ = 0;
};

}  // namespace kadans
