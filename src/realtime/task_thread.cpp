
#include "task_thread.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <system_error>
#include <utility>

#include <sched.h>
#include <sys/resource.h>

#include "realtime/machine/placement.h"
#include "signal/monotonic_clock.h"
#include "signal/quiet_thread.h"

namespace kadans {

void Periodic::leave_out(std::int64_t periods) noexcept {
  due_ns_ += periods * period_ns_;
  number_ += static_cast<std::uint64_t>(periods);
  statistics_.missed.add(static_cast<std::uint64_t>(periods));
  missed_ += static_cast<std::uint32_t>(std::min<std::int64_t>(periods, UINT32_MAX - missed_));
}

std::int64_t Periodic::plan() noexcept {
  if (!running_) return due_ns_;
  due_ns_ += period_ns_;
  ++number_;
  const std::int64_t now_ns = wait_.now_ns();
  if (now_ns >= due_ns_) {
    statistics_.overruns.add(1);
    leave_out((now_ns - due_ns_) / period_ns_ + 1);
  }
  if (due_ns_ - woke_ns_ < period_ns_ / 2) leave_out(1);
  return due_ns_;
}

Beat Periodic::wake() noexcept {
  wait_.until(due_ns_);
  Beat beat{.woke_ns = wait_.now_ns()};
  const std::int64_t lateness_ns = beat.woke_ns - due_ns_;
  if (lateness_ns >= period_ns_) {
    statistics_.late_wakes.add(1);
    leave_out(lateness_ns / period_ns_);
  }
  beat.number = number_;
  beat.due_ns = due_ns_;
  beat.stands = lateness_ns < 0 || (running_ && beat.woke_ns <= woke_ns_);
  if (beat.stands) {  // the same grid point again
    if (running_) due_ns_ -= period_ns_, --number_;
    return beat;
  }
  beat.missed = std::exchange(missed_, 0);
  note_wake(beat, lateness_ns);
  return beat;
}

void Periodic::note_wake(Beat& beat, std::int64_t lateness_ns) noexcept {
  statistics_.lateness.add(lateness_ns);
  const std::int64_t interval_ns = running_ ? beat.woke_ns - woke_ns_ : period_ns_;
  if (running_) statistics_.jitter.add(std::abs(interval_ns - period_ns_));
  beat.dt_s = 1e-9 * static_cast<double>(interval_ns);
  woke_ns_ = beat.woke_ns;
  running_ = true;
}

void Periodic::done() noexcept { statistics_.execution.add(wait_.now_ns() - woke_ns_); }

namespace {

std::uint64_t faults_of_this_thread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt);
}

}  // namespace

TaskThread::TaskThread(TaskSettings settings, Task& task, Wait& wait)
    : settings_(std::move(settings)),
      task_(task),
      wait_(wait),
      periodic_(wait, settings_.period_ns, settings_.first_ns) {}

TaskThread::~TaskThread() {
  stop();
  join();
}

void TaskThread::start() {
  const std::string shown = settings_.name.substr(0, 15);
  // With its priority from the first instruction on: on a busy machine it would wait long to give it to itself.
  const auto create = [&](int priority) {
    return start_quiet_thread<&TaskThread::run>(thread_, {shown.c_str(), settings_.stack_bytes, priority}, this);
  };
  int error = create(settings_.priority);
  if (error != 0 && settings_.priority > 0) {
    refused_priority_.store(error, std::memory_order_relaxed);
    error = create(0);
  }
  if (error != 0) throw std::system_error(error, std::generic_category(), "no thread for task " + settings_.name);
  joinable_ = true;
}

void TaskThread::join() noexcept {
  if (!std::exchange(joinable_, false)) return;
  pthread_join(thread_, nullptr);
}

bool TaskThread::join_until(std::int64_t monotonic_ns) noexcept {
  if (!joinable_) return true;
  const timespec end = timespec_of(monotonic_ns);
  if (pthread_clockjoin_np(thread_, nullptr, CLOCK_MONOTONIC, &end) != 0) return false;
  joinable_ = false;
  return true;
}

void TaskThread::move_to_cpu() noexcept {
  if (settings_.cpu < 0) return;
  cpu_set_t cpus;
  CPU_ZERO(&cpus);
  CPU_SET(static_cast<std::size_t>(settings_.cpu), &cpus);
  refused_cpu_.store(pthread_setaffinity_np(pthread_self(), sizeof cpus, &cpus), std::memory_order_relaxed);
}

void TaskThread::run() noexcept {
  move_to_cpu();
  touch_stack();
  begun_.store(true, std::memory_order_relaxed);
  wait_.begin();
  try {
    loop();
  } catch (const std::exception& error) {
    fail(error.what());
  }
  wait_.end();
  cpu_time_at_end_ns_.store(thread_cpu_ns(), std::memory_order_relaxed);
  over_.store(true, std::memory_order_release);
}

void TaskThread::loop() {
  std::uint64_t beats = 0, faults_before = 0;
  int standing = 0;
  while (!stop_.load(std::memory_order_relaxed)) {
    const std::int64_t due_ns = periodic_.plan();
    if (settings_.prepare_ns > 0) {
      wait_.until(due_ns - settings_.prepare_ns);
      prepare_until(due_ns);
    }
    const Beat beat = periodic_.wake();
    standing = beat.stands ? standing + 1 : 0;
    if (standing == standing_max) fail("the clock stands still");
    if (standing == standing_max) break;
    if (beat.stands) continue;
    const bool goes_on = task_.beat(beat);
    periodic_.done();
    if (++beats == warm_up_beats) faults_before = faults_of_this_thread();
    if (!goes_on) break;
  }
  page_faults_ = beats >= warm_up_beats ? faults_of_this_thread() - faults_before : 0;
}

// Over and over, as what is near is not for long: others share the caches. The last ends just before the beat is due.
void TaskThread::prepare_until(std::int64_t due_ns) noexcept {
  std::int64_t now_ns = wait_.now_ns(), took_ns = 0;
  do {
    const std::int64_t began_ns = now_ns;
    task_.prepare();
    now_ns = wait_.now_ns();
    took_ns = now_ns - began_ns;
    preparation_.add(took_ns);
  } while (took_ns > 0 && now_ns + 2 * took_ns < due_ns);
}

void TaskThread::fail(const char* why) noexcept { std::snprintf(failure_.data(), failure_.size(), "%s", why); }

std::int64_t TaskThread::cpu_time_ns() const noexcept {
  if (over() || !joinable_) return cpu_time_at_end_ns_.load(std::memory_order_relaxed);
  clockid_t clock{};
  return pthread_getcpuclockid(thread_, &clock) == 0 ? clock_ns(clock) : 0;
}

}  // namespace kadans
