// Keeps a simulation at the pace that clients ask for: a multiple of the wall clock, which may change while it runs,
// held, or tick by tick.
#pragma once

#include <chrono>

#include "remote/page/live_hub.h"
#include "scenario/run.h"

namespace kadans {

class LivePacer final : public RunObserver {
 public:
  explicit LivePacer(LivePace& pace) noexcept : pace_(pace) {}
  void tick(double time_s, std::span<const double> row) override;

 private:
  void hold();

  LivePace& pace_;
  std::chrono::steady_clock::time_point began_;
  double from_s_ = 0, speed_ = 0;
};

}  // namespace kadans
