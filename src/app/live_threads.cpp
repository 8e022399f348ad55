#include "live_threads.h"

#include "kadans/realtime/placement.h"

namespace kadans {
namespace {

constexpr std::int64_t start_ns = 1'000'000;  // from the last thread's coming up to time 0
constexpr std::int64_t record_period_ns = 20'000'000, joystick_period_ns = 10'000'000;

}  // namespace

LiveThreads::LiveThreads(const LiveTiming& timing, const LiveTasks& tasks)
    : timing_(timing),
      line_(2 + std::size_t{tasks.plant != nullptr} + std::size_t{tasks.record != nullptr} +
                std::size_t{tasks.joystick != nullptr},
            start_ns),
      supervisor_wait_(timing.virtual_time ? virtual_time_.make_wait() : nullptr) {
  const auto priority = [&](int wanted) { return timing.real_time && !timing.virtual_time ? wanted : 0; };
  const std::int64_t period_ns = timing.control_period_ns;
  // On the wall clock the model is half a period behind, so that what it is told and what it says is always as old; and
  // it shares the control thread's CPU: when the machine takes that away for a while, time passes for neither.
  const std::int64_t prepare_ns = timing.virtual_time ? 0 : timing.spin_ns * 2 / 5;
  const std::int64_t plant_first_ns = timing.virtual_time ? 0 : period_ns / 2;
  add({.name = "control",
       .period_ns = period_ns,
       .first_ns = period_ns,
       .prepare_ns = prepare_ns,
       .priority = priority(control_priority),
       .cpu = timing.virtual_time ? -1 : timing.cpu},
      tasks.control, timing.spin_ns);
  add({.name = "behaviors",
       .period_ns = timing.behavior_period_ns,
       .first_ns = 2 * period_ns,
       .prepare_ns = timing.virtual_time ? 0 : timing.spin_ns / 2,
       .priority = priority(behavior_priority),
       .stack_bytes = std::size_t{1} << 20U},
      tasks.behaviors, timing.spin_ns);
  if (tasks.plant != nullptr) {
    add({.name = "plant",
         .period_ns = period_ns,
         .first_ns = plant_first_ns,
         .priority = priority(plant_priority),
         .cpu = timing.virtual_time ? -1 : timing.cpu,
         .stack_bytes = std::size_t{1} << 20U},
        *tasks.plant, 0);
  }
  if (tasks.joystick != nullptr) {
    add({.name = "joystick", .period_ns = joystick_period_ns, .priority = priority(joystick_priority)}, *tasks.joystick,
        0);
  }
  if (tasks.record == nullptr) return;
  // A machine busy for seconds must not cost rows: the ring holds one or two.
  add({.name = "record", .period_ns = record_period_ns, .priority = priority(record_priority)}, *tasks.record, 0);
}

std::unique_ptr<Wait> LiveThreads::make_wait(std::int64_t spin_ns) {
  if (timing_.virtual_time) return virtual_time_.make_wait();
  return std::make_unique<PosixWait>(spin_ns, line_);
}

void LiveThreads::add(const TaskSettings& settings, Task& task, std::int64_t spin_ns) {
  waits_.push_back(make_wait(spin_ns));
  threads_.push_back(std::make_unique<TaskThread>(settings, task, *waits_.back()));
}

void LiveThreads::start() {
  if (!timing_.virtual_time) {
    if (timing_.keep_awake) awake_.emplace(timing_.cpu);
    (void)leave_cpu(timing_.cpu);  // and so do the threads that are started here
  }
  try {
    for (const auto& thread : threads_) thread->start();
  } catch (...) {
    for (const auto& thread : threads_) thread->stop();
    line_.open();
    throw;
  }
  if (!timing_.virtual_time) supervisor_wait_ = std::make_unique<PosixWait>(0, line_.origin_ns());
}

void LiveThreads::stop() noexcept {
  for (const auto& thread : threads_) thread->stop();
  supervisor_wait_->end();
  for (const auto& thread : threads_) thread->join();
}

}  // namespace kadans
