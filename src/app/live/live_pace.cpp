#include "live_pace.h"

#include <thread>

#include "app/terminal.h"

namespace kadans {
namespace {

constexpr std::chrono::milliseconds look_again{5}, late_max{100};

}  // namespace

void LivePacer::hold() {
  while (pace_.held.load(std::memory_order_relaxed) && !interrupted()) {
    std::uint32_t steps = pace_.steps.load();
    if (steps > 0 && pace_.steps.compare_exchange_strong(steps, steps - 1)) return;
    speed_ = 0;  // so that timing starts anew afterwards
    std::this_thread::sleep_for(look_again);
  }
}

void LivePacer::tick(double time_s, std::span<const double>) {
  hold();
  const double speed = pace_.speed.load(std::memory_order_relaxed);
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> passed((time_s - from_s_) / (speed_ > 0 ? speed_ : 1));
  const auto due = began_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(passed);
  if (speed != speed_ || now > due + late_max) {  // lost time is not caught up
    began_ = now;
    from_s_ = time_s;
    speed_ = speed;
    return;
  }
  std::this_thread::sleep_until(due);
}

}  // namespace kadans
