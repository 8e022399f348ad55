// Observers of a running scenario: the progress bar, the pace, the drawn signals.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "remote/page/live_hub.h"
#include "scenario/report/report.h"
#include "scenario/run.h"

namespace kadans {

// Slows a simulation down to a pace, which clients may change while it runs: a multiple of the wall clock, held, or
// tick by tick. One that is slower does not catch up.
class ViewerPacer final : public RunObserver {
 public:
  explicit ViewerPacer(LivePace& pace) noexcept : pace_(pace) {}
  void tick(double time_s, std::span<const double> row) override;

 private:
  void hold();

  LivePace& pace_;
  std::chrono::steady_clock::time_point began_;
  double from_s_ = 0, speed_ = 0;
};

// A progress bar on stderr, which is removed at the end. It also asks for a stop after SIGINT or SIGTERM.
class ProgressBar final : public RunObserver {
 public:
  ProgressBar(double duration_s, bool shown) : duration_s_(duration_s), shown_(shown) {}
  ~ProgressBar() override;
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void tick(double time_s, std::span<const double> row) override;
  bool stop_asked() const override;

 private:
  double duration_s_;
  bool shown_;
  int drawn_percent_ = -1;
};

// Keeps every n-th value of one signal for the report.
class TraceObserver final : public RunObserver {
 public:
  TraceObserver(std::string title, SignalId signal, double duration_s);
  void tick(double time_s, std::span<const double> row) override;
  const ReportTrace& trace() const noexcept { return trace_; }

 private:
  SignalId signal_;
  double every_s_;
  double next_s_ = 0;
  ReportTrace trace_;
};

}  // namespace kadans
