#include "run_threads.h"

#include <chrono>
#include <thread>

#include "app/terminal.h"
#include "realtime/machine/placement.h"

namespace kadans {
namespace {

constexpr std::int64_t start_ns = 1'000'000;  // from the start of the last thread to time 0
constexpr std::int64_t record_period_ns = 20'000'000, joystick_period_ns = 10'000'000;

}  // namespace

RunThreads::RunThreads(const RunTiming& timing, const RunTasks& tasks)
    : timing_(timing),
      line_(2 + std::size_t{tasks.plant != nullptr} + std::size_t{tasks.record != nullptr} +
                std::size_t{tasks.joystick != nullptr} + std::size_t{tasks.supervisor != nullptr},
            start_ns),
      supervisor_wait_(timing.virtual_time ? virtual_time_.make_wait(interrupted) : nullptr) {
  const auto priority = [&](int wanted) { return timing.real_time && !timing.virtual_time ? wanted : 0; };
  const std::int64_t period_ns = timing.control_period_ns;
  // On the wall clock the model runs half a period later, so that its inputs and outputs always have the same age. It
  // shares the control thread's CPU: when the machine takes that CPU away for a while, time passes for neither.
  const std::int64_t prepare_ns = timing.virtual_time ? 0 : timing.spin_ns / 4;
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
       .prepare_ns = 2 * prepare_ns,
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
  if (tasks.supervisor != nullptr)
    add({.name = "supervisor", .period_ns = tasks.supervisor_period_ns, .first_ns = 3 * period_ns}, *tasks.supervisor,
        0);
  if (tasks.record == nullptr) return;
  // Rows must not be lost when the machine is busy for seconds, because the ring holds only one or two seconds.
  add({.name = "record", .period_ns = record_period_ns, .priority = priority(record_priority)}, *tasks.record, 0);
}

std::unique_ptr<Wait> RunThreads::make_wait(std::int64_t spin_ns) {
  if (timing_.virtual_time) return virtual_time_.make_wait();
  return std::make_unique<PosixWait>(spin_ns, line_);
}

void RunThreads::add(const TaskSettings& settings, Task& task, std::int64_t spin_ns) {
  waits_.push_back(make_wait(spin_ns));
  threads_.push_back(std::make_unique<TaskThread>(settings, task, *waits_.back()));
}

bool RunThreads::start() {
  if (!timing_.virtual_time) {
    if (timing_.keep_awake) awake_.emplace(timing_.cpu);
    (void)leave_cpu(timing_.cpu);  // the threads that are started here do so, too
  }
  try {
    for (const auto& thread : threads_) thread->start();
  } catch (...) {
    cancel();
    throw;
  }
  if (timing_.virtual_time) return true;
  const bool all = wait_for_all();
  supervisor_wait_ = std::make_unique<PosixWait>(0, line_.origin_ns());
  return all;
}

bool RunThreads::wait_for_all() {
  constexpr std::chrono::milliseconds look_again{10};
  constexpr std::int64_t patience_ns = 1'000'000'000, say_again_ns = 10'000'000'000;
  std::int64_t say_ns = WallClock().now_ns() + patience_ns;
  while (!line_.is_open()) {
    if (interrupted()) {
      cancel();
      return false;
    }
    if (WallClock().now_ns() >= say_ns) {
      say_ns += say_again_ns;
      print_error("waiting for a CPU: " + not_begun() + " cannot begin; another program in real time keeps it");
    }
    std::this_thread::sleep_for(look_again);
  }
  return true;
}

std::string RunThreads::not_begun() const {
  std::string names;
  for (const auto& thread : threads_) {
    if (!thread->begun()) names += (names.empty() ? "" : ", ") + thread->settings().name;
  }
  return names.empty() ? "a thread" : names;
}

// A thread that is stopped before the line opens does not beat even once.
void RunThreads::cancel() noexcept {
  for (const auto& thread : threads_) thread->stop();
  line_.open();
}

std::vector<std::string> RunThreads::stop(std::int64_t patience_ns) noexcept {
  for (const auto& thread : threads_) thread->stop();
  if (supervisor_wait_) supervisor_wait_->end();
  // When a thread hangs, virtual time stands still and all other threads wait for it.
  if (timing_.virtual_time && !join_all(patience_ns).empty()) virtual_time_.release();
  return join_all(patience_ns);
}

std::vector<std::string> RunThreads::join_all(std::int64_t patience_ns) noexcept {
  const std::int64_t end_ns = WallClock().now_ns() + patience_ns;
  std::vector<std::string> hanging;
  for (const auto& thread : threads_) {
    if (!thread->join_until(end_ns)) hanging.push_back(thread->settings().name);
  }
  return hanging;
}

}  // namespace kadans
