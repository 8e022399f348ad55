// The emergency stop. Anybody asks for it, on any thread, without waiting; the safety layer takes it in the tick in
// which it arrives: a fault like others, named, with the words of who asked. The robot damps from that tick on and is
// off safety.damp_s later. It stays so until somebody outside lifts it; no command of a behavior does.
//
// The same way down ends every run. Then nothing failed, so it is no fault, and nothing takes it back.
//
// Memory order: the words belong to whoever moved their stage from none, until he says that they are there; then to the
// control thread, until it says that there are none. Asking is released after them and acquired before they are looked
// at, so who asks alone is always named. Each order is needed: tests/interleavings weakens one after the other and
// finds what breaks.
#pragma once

#include <cstdint>
#include <string_view>

#include "kadans/exchange/memory.h"
#include "kadans/signal/fault.h"

namespace kadans {

template <typename Words, typename Memory = MachineMemory>
class BasicEmergencyStop {
 public:
  // Any thread, wait-free. Of those who ask in one tick the first is named; nobody when he is still writing.
  void ask(const Words& who) noexcept {
    Stage stage = none;
    if (Memory::at(stage_).compare_exchange_strong(stage, being_written, std::memory_order_acquire,
                                                   std::memory_order_relaxed)) {
      who_ = who;
      Memory::at(stage_).store(there, std::memory_order_release);
    }
    // It counts, be the words there or not. A mere store would hide what another who asks has released just before: his
    // words would be left, and whoever asks next, be it minutes later, would be called by them.
    (void)Memory::at(asked_).exchange(true, std::memory_order_release);
  }
  // Any thread, wait-free: all faults are cleared, this one among them. Who asks in the same tick is heard, then this
  // is not. It carries nothing, so its order is relaxed.
  void lift() noexcept { Memory::at(lifted_).store(true, std::memory_order_relaxed); }
  // Any thread: the run is over, the robot goes down and stays down.
  void leave() noexcept { Memory::at(leaving_).store(true, std::memory_order_relaxed); }

  // Control thread: somebody asked since the last time.
  [[nodiscard]] bool take(Words& who) noexcept {
    if (!Memory::at(asked_).load(std::memory_order_relaxed)) return false;
    if (!Memory::at(asked_).exchange(false, std::memory_order_acquire)) return false;
    who = {};
    if (Memory::at(stage_).load(std::memory_order_acquire) == there) {
      who = who_;
      Memory::at(stage_).store(none, std::memory_order_release);
    }
    return true;
  }
  // Control thread: likewise, of lift().
  [[nodiscard]] bool take_lift() noexcept {
    return Memory::at(lifted_).load(std::memory_order_relaxed) &&
           Memory::at(lifted_).exchange(false, std::memory_order_relaxed);
  }
  bool leaving() const noexcept { return Memory::at(leaving_).load(std::memory_order_relaxed); }

 private:
  enum Stage : std::uint8_t { none, being_written, there };
  template <typename T>
  using Word = typename Memory::template Word<T>;

  Word<bool> asked_{false}, lifted_{false}, leaving_{false};
  Word<Stage> stage_{none};
  Words who_{};
};

class EmergencyStop : public BasicEmergencyStop<FaultWords> {
 public:
  void ask(std::string_view who) noexcept { BasicEmergencyStop::ask(fault_words(who)); }
};

}  // namespace kadans
