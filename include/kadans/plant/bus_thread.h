// A thread beside the control thread, on which a plant serves its bus. Signals disturb only the thread that starts it.
// Its priority is below the control thread's; without the right to one it is a usual thread. All of its stack may be
// locked memory, so it has 256 kB.
//
// One owner, off the tick; asked_to_stop() by the thread.
#pragma once

#include <atomic>
#include <functional>

#include <pthread.h>

namespace kadans {

class BusThread {
 public:
  BusThread() = default;
  ~BusThread() { stop(); }
  BusThread(const BusThread&) = delete;
  BusThread& operator=(const BusThread&) = delete;

  // Stops what it serves first. `serve` ends soon after asked_to_stop(). `name`: at most 15 characters, shown by ps and
  // top. Throws InputError: "the system gives no thread to WHOM".
  void start(const char* name, const char* whom, std::function<void()> serve);
  void ask_to_stop() noexcept { stop_.store(true, std::memory_order_relaxed); }
  bool asked_to_stop() const noexcept { return stop_.load(std::memory_order_relaxed); }
  void stop() noexcept;  // asks, and waits for its end

 private:
  std::function<void()> serve_;
  pthread_t thread_{};
  bool runs_ = false;
  std::atomic<bool> stop_{false};
};

}  // namespace kadans
