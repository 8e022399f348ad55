#include "observers.h"

#include <algorithm>
#include <cstdio>
#include <thread>

#include "app/terminal.h"

namespace kadans {
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

void Pace::tick(double time_s, std::span<const double>) {
  const auto since =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(time_s));
  const auto now = std::chrono::steady_clock::now();
  if (!running_ || now > began_ + since + std::chrono::milliseconds(100)) began_ = now - since;  // late: start anew
  running_ = true;
  std::this_thread::sleep_until(began_ + since);
}

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
