// Virtual time for real threads. Time stands still while any of the threads works. When all of them wait, time jumps to
// the earliest due time, and all threads that are due then run at once. So the exchange of data between them is real,
// but nothing depends on their speed: a model may be slower than the wall clock, and the program may run under a
// sanitizer.
//
// Unlike lockstep (engine/lockstep.h) a run does not repeat bit for bit: the system chooses which thread goes first
// within an instant.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "wait.h"

namespace kadans {

class VirtualTime {
 public:
  // To be called before the thread that will wait is started: from now on time stands until this thread waits, or ends.
  // This object must outlive the Wait that it makes. While time stands, until() asks give_up() some twenty times per
  // second of wall time; when that says true, it returns early.
  std::unique_ptr<Wait> make_wait(bool (*give_up)() noexcept = nullptr);

  // Any thread: ends all waits, now and later; time stands.
  void release() noexcept;
  // Any thread.
  std::int64_t now_ns() const noexcept { return now_ns_.load(std::memory_order_acquire); }

 private:
  class Member;
  struct Place {
    std::int64_t due_ns = 0;
    bool waits = false;
  };

  void wait(Place& place, std::int64_t time_ns, bool (*give_up)() noexcept) noexcept;
  void leave(const Place& place) noexcept;
  void advance() noexcept;

  std::atomic<std::int64_t> now_ns_{0};
  std::mutex mutex_;
  std::condition_variable moved_;
  std::vector<std::unique_ptr<Place>> places_;
  bool released_ = false;
};

}  // namespace kadans
