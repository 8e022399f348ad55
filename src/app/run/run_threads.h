// The threads of a live run and their clocks: control, behaviors, the model, the joystick, the record, and the waiting
// of the supervisor's thread. They are the same on the wall clock and on virtual time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "realtime/engine_tasks.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"
#include "realtime/virtual_time.h"

namespace kadans {

// The model stands for hardware, which never waits. So it has a higher priority than the control thread: anything that
// delays the model must delay the control thread, too. Otherwise time would pass for control alone, and every sensor
// would fall silent.
inline constexpr int control_priority = 90, plant_priority = 92, behavior_priority = 40, joystick_priority = 30,
                     record_priority = 20;
// A thread that must end a hanging thread may not wait for the CPU that the hanging one occupies. So the supervisor is
// above the threads that play behaviors, the last resort is above everything, and a process of behaviors is below the
// thread that kills it.
inline constexpr int last_resort_priority = 95, supervisor_priority = 45, behavior_process_priority = 39;

struct RunTasks {
  ControlTask& control;
  BehaviorTask& behaviors;
  PlantTask* plant = nullptr;  // of a model, else nullptr
  Task* record = nullptr;
  Task* joystick = nullptr;
  Task* supervisor = nullptr;
  std::int64_t supervisor_period_ns = 0;
};

struct RunTiming {
  std::int64_t control_period_ns = 1'000'000, behavior_period_ns = 10'000'000;
  bool virtual_time = false;
  bool real_time = true;  // use real-time priorities
  bool keep_awake = true;
  std::int64_t spin_ns = default_spin_ns;
  int cpu = 0;  // of the control thread
};

class RunThreads {
 public:
  // The tasks must outlive this object. Time 0 is a little after all threads have started. While the supervisor waits
  // for the threads, or for virtual time that stands still, an interrupt of the program ends the wait.
  RunThreads(const RunTiming& timing, const RunTasks& tasks);

  // Waits until all threads have a CPU. After a second, and then every ten seconds, it tells which have none. False:
  // the wait was ended and nothing has begun. Throws std::system_error.
  [[nodiscard]] bool start();
  // Call it when the supervisor no longer waits. Returns the names of the threads that still run after `patience_ns`.
  // The caller must not destroy anything that such a thread uses.
  [[nodiscard]] std::vector<std::string> stop(std::int64_t patience_ns) noexcept;

  Wait& supervisor() noexcept { return *supervisor_wait_; }
  const TaskThread& control() const noexcept { return *threads_[0]; }
  const TaskThread& behaviors() const noexcept { return *threads_[1]; }
  const std::vector<std::unique_ptr<TaskThread>>& all() const noexcept { return threads_; }
  const KeepAwake* keep_awake() const noexcept { return awake_ ? &*awake_ : nullptr; }
  // Time 0 on CLOCK_MONOTONIC; valid on the wall clock after start().
  std::int64_t origin_ns() const noexcept { return timing_.virtual_time ? WallClock().now_ns() : line_.origin_ns(); }

 private:
  void add(const TaskSettings& settings, Task& task, std::int64_t spin_ns);
  std::unique_ptr<Wait> make_wait(std::int64_t spin_ns);
  std::vector<std::string> join_all(std::int64_t patience_ns) noexcept;
  std::string not_begun() const;
  bool wait_for_all();
  void cancel() noexcept;

  RunTiming timing_;
  StartLine line_;
  VirtualTime virtual_time_;
  std::unique_ptr<Wait> supervisor_wait_;
  std::vector<std::unique_ptr<Wait>> waits_;
  std::vector<std::unique_ptr<TaskThread>> threads_;
  std::optional<KeepAwake> awake_;
};

}  // namespace kadans
