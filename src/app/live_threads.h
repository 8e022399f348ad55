// The threads of a live run on their clocks: control, behaviors, the model, the record; and the supervisor's own place
// among them. The same on the wall clock and on virtual time.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kadans/realtime/engine_tasks.h"
#include "kadans/realtime/keep_awake.h"
#include "kadans/realtime/plant_link.h"
#include "kadans/realtime/posix_wait.h"
#include "kadans/realtime/start_line.h"
#include "kadans/realtime/task_thread.h"
#include "kadans/realtime/virtual_time.h"

namespace kadans {

// The model stands for hardware, which waits for nobody: whatever keeps it from its step must keep the control thread
// too, or time would pass for control alone and every sensor would fall silent.
inline constexpr int control_priority = 90, plant_priority = 92, behavior_priority = 40, joystick_priority = 30,
                     record_priority = 20;
// Whoever must end what hangs may not wait for a CPU that it keeps: the supervisor is above all that plays behaviors,
// the last resort above everything, a process of behaviors below the thread that kills it.
inline constexpr int last_resort_priority = 95, supervisor_priority = 45, behavior_process_priority = 39;

struct LiveTasks {
  ControlTask& control;
  BehaviorTask& behaviors;
  PlantTask* plant = nullptr;  // of a model
  Task* record = nullptr;
  Task* joystick = nullptr;
};

struct LiveTiming {
  std::int64_t control_period_ns = 1'000'000, behavior_period_ns = 10'000'000;
  bool virtual_time = false;
  bool real_time = true;  // priorities
  bool keep_awake = true;
  std::int64_t spin_ns = default_spin_ns;
  int cpu = 0;  // of the control thread
};

class LiveThreads {
 public:
  // The tasks must outlive it. Time 0 is a little later than when all threads are up. While the supervisor waits for
  // them, or on virtual time that stands, it looks whether to `give_up`.
  LiveThreads(const LiveTiming& timing, const LiveTasks& tasks, bool (*give_up)() noexcept);

  // Waits until all threads have a CPU; after a second, and from then on each ten, `tell` says which do not. False: it
  // was given up and nothing has begun. Throws std::system_error.
  [[nodiscard]] bool start(void (*tell)(const std::string& message));
  // Once the supervisor does not wait any more. The threads that go on after `patience_ns`, by name: whoever is told of
  // one may not destroy anything that it works on.
  [[nodiscard]] std::vector<std::string> stop(std::int64_t patience_ns) noexcept;

  Wait& supervisor() noexcept { return *supervisor_wait_; }
  const TaskThread& control() const noexcept { return *threads_[0]; }
  const TaskThread& behaviors() const noexcept { return *threads_[1]; }
  const std::vector<std::unique_ptr<TaskThread>>& all() const noexcept { return threads_; }
  const KeepAwake* keep_awake() const noexcept { return awake_ ? &*awake_ : nullptr; }
  // Time 0 on CLOCK_MONOTONIC, on the wall clock and once started.
  std::int64_t origin_ns() const noexcept { return timing_.virtual_time ? WallClock().now_ns() : line_.origin_ns(); }

 private:
  void add(const TaskSettings& settings, Task& task, std::int64_t spin_ns);
  std::unique_ptr<Wait> make_wait(std::int64_t spin_ns);
  std::vector<std::string> join_all(std::int64_t patience_ns) noexcept;
  std::string not_begun() const;
  bool wait_for_all(void (*tell)(const std::string& message));
  void cancel() noexcept;

  LiveTiming timing_;
  bool (*give_up_)() noexcept;
  StartLine line_;
  VirtualTime virtual_time_;
  std::unique_ptr<Wait> supervisor_wait_;
  std::vector<std::unique_ptr<Wait>> waits_;
  std::vector<std::unique_ptr<TaskThread>> threads_;
  std::optional<KeepAwake> awake_;
};

}  // namespace kadans
