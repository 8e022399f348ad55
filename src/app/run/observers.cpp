#include "observers.h"

#include <algorithm>
#include <cstdio>
#include <thread>

#include "app/terminal.h"

namespace kadans {
namespace {

constexpr std::chrono::milliseconds look_again{5}, late_max{100};

}  // namespace

void ViewerPacer::hold() {
  while (pace_.held.load(std::memory_order_relaxed) && !interrupted()) {
    std::uint32_t steps = pace_.steps.load();
    if (steps > 0 && pace_.steps.compare_exchange_strong(steps, steps - 1)) return;
    speed_ = 0;  // so that timing starts anew afterwards
    std::this_thread::sleep_for(look_again);
  }
}

void ViewerPacer::tick(double time_s, std::span<const double>) {
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

namespace {

constexpr int bar_width = 40;
constexpr double trace_points = 2000;

}  // namespace

ProgressBar::~ProgressBar() {
  if (shown_ && drawn_percent_ >= 0) std::fprintf(stderr, "\r\033[K");
}

void ProgressBar::tick(double time_s, std::span<const double>) {
  if (!shown_) return;
  const int percent = static_cast<int>(100 * time_s / duration_s_);
  if (percent == drawn_percent_) return;
  drawn_percent_ = percent;
  const int filled = std::clamp(percent * bar_width / 100, 0, bar_width);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(bar_width - filled), '.');
  std::fprintf(stderr, "\r  [%s] %5.1f of %.1f s", bar.c_str(), time_s, duration_s_);
  std::fflush(stderr);
}

bool ProgressBar::stop_asked() const { return interrupted(); }

TraceObserver::TraceObserver(std::string title, SignalId signal, double duration_s)
    : signal_(signal), every_s_(duration_s / trace_points), trace_{std::move(title), {}, duration_s} {
  trace_.values.reserve(static_cast<std::size_t>(trace_points) + 2);
}

void TraceObserver::tick(double time_s, std::span<const double> row) {
  if (time_s < next_s_) return;
  next_s_ += every_s_;
  trace_.values.push_back(row[signal_]);
}

}  // namespace kadans
