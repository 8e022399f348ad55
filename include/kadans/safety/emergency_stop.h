// The emergency stop. Anybody asks for it, on any thread, without waiting; the safety layer takes it in the tick in
// which it arrives: a fault like others, named, with the words of who asked, latched until faults are cleared. The
// robot damps from that tick on and is off safety.damp_s later.
//
// The same way down ends every run. Then nothing failed, so it is no fault, and nothing takes it back.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "kadans/signal/fault.h"

namespace kadans {

class EmergencyStop {
 public:
  // Any thread, wait-free. Of those who ask in one tick the first is named; nobody when he is still writing.
  void ask(std::string_view who) noexcept;
  // Any thread: the run is over, the robot goes down and stays down.
  void leave() noexcept { leaving_.store(true, std::memory_order_relaxed); }

  // Control thread: somebody asked since the last time.
  [[nodiscard]] bool take(FaultWords& who) noexcept;
  bool leaving() const noexcept { return leaving_.load(std::memory_order_relaxed); }

 private:
  enum class Words : std::uint8_t { none, being_written, there };

  std::atomic<bool> asked_{false}, leaving_{false};
  std::atomic<Words> words_{Words::none};
  FaultWords who_{};  // whoever moved words_ from none writes it; the control thread reads it when it is there
};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::uint8_t>::is_always_lock_free);

}  // namespace kadans
