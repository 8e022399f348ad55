#include "periodic.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

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

}  // namespace kadans
