// The emergency stop. Any thread may ask for it, without waiting. The safety layer takes it in the tick in which it
// arrives, as a fault with a name like others; the fault carries the words of who asked. The robot damps from that tick
// on and is off safety.damp_s later. It stays off until somebody outside lifts the stop; no command of a behavior does.
//
// Every run ends in the same way: damp, then off. Then nothing failed, so it is no fault, and nothing takes it back.
//
// Memory order: the words belong to the thread that moved their stage from `none`, until it moves the stage to `there`.
// Then they belong to the control thread, until it moves the stage back to `none`. The request is released after the
// words are written and acquired before they are read, so if only one asks, its words are always found. Each order is
// needed: tests/interleavings weakens one after the other and finds what breaks.
#pragma once

#include <cstdint>
#include <string_view>

#include "kadans/exchange/memory.h"
#include "kadans/signal/fault.h"

namespace kadans {

template <typename Words, typename Memory = MachineMemory>
class BasicEmergencyStop {
 public:
  // Any thread, wait-free. If several ask in one tick, the fault has the words of the first; it has none while the
  // first is still writing them.
  void ask(const Words& who) noexcept {
    Stage stage = none;
    if (Memory::at(stage_).compare_exchange_strong(stage, being_written, std::memory_order_acquire,
                                                   std::memory_order_relaxed)) {
      who_ = who;
      Memory::at(stage_).store(there, std::memory_order_release);
    }
    // The request counts, whether the words are there or not. It is an exchange, because a plain store would hide what
    // another asker released just before: the words of that one would be left over and be taken for the words of the
    // next one, even minutes later.
    (void)Memory::at(asked_).exchange(true, std::memory_order_release);
  }
  // Any thread, wait-free: clears all faults, this one among them. When somebody asks for a stop in the same tick, the
  // stop counts and the lift does not. It carries no data, so its order is relaxed.
  void lift() noexcept { Memory::at(lifted_).store(true, std::memory_order_relaxed); }
  // Any thread: the run is over, the robot goes down and stays down.
  void leave() noexcept { Memory::at(leaving_).store(true, std::memory_order_relaxed); }

  // Control thread: whether somebody has asked since the last call.
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
  // Control thread: whether lift() was called since the last call.
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

// What a tick heard, bits of one number.
enum StopHeard : std::uint32_t { heard_lift = 1, heard_stop = 2, heard_leave = 4 };

class EmergencyStop : public BasicEmergencyStop<FaultWords> {
 public:
  void ask(std::string_view who) noexcept { BasicEmergencyStop::ask(fault_words(who)); }
  void ask_as_recorded(const FaultWords& who) noexcept { BasicEmergencyStop::ask(who); }
};

}  // namespace kadans
