// A clock that goes on only when it is told to, and that wakes late by what the test wants.
#pragma once

#include <utility>

#include "realtime/wait.h"

namespace kadans {

class FakeWait final : public Wait {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void until(std::int64_t time_ns) noexcept override {
    if (frozen) return;
    if (time_ns > now_ns_) now_ns_ = time_ns;
    now_ns_ += std::exchange(late_ns, 0);
  }
  void work(std::int64_t for_ns) noexcept { now_ns_ += for_ns; }

  std::int64_t late_ns = 0;  // of the next wake-up
  bool frozen = false;

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace kadans
