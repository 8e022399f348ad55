// Virtual time for real threads: it stands while any of them works, and when all wait it jumps to the first that is
// due. All that are due then run at once, so the exchange of data between them is real, while nothing depends on how
// fast they are: a model may be slower than the wall clock, and a sanitizer may look on.
//
// Unlike lockstep (engine/lockstep.h) a run does not repeat bit for bit: who goes first within an instant is the
// system's choice.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "kadans/realtime/wait.h"

namespace kadans {

class VirtualTime {
 public:
  // Before the thread that will wait on it is started: from now on time stands until it waits, or ends. The time must
  // outlive what it made. While time stands, until() looks some twenty times a second of wall time whether to
  // `give_up`, and then returns early.
  std::unique_ptr<Wait> make_wait(bool (*give_up)() noexcept = nullptr);

  // Any thread: nobody waits any more, now or later; time stands.
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
