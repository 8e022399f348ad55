// The state of the control objects in the tick of a fault, for the flight recorder.
//
// It is kept when the safety level rises to hold or beyond, after the samples of the tick were checked and before any
// object computes. So an object that gets its bytes back (kadans/control/state_bytes.h, Levels::low) computes from the
// samples of that tick what it computed then. That is how a fault on the robot becomes a unit test.
//
// Threads: watch() the control thread, which never waits; facts() any other.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "kadans/control/control_sets.h"
#include "kadans/signal/status.h"
#include "signal/byte_order.h"

namespace kadans {

class FaultState {
 public:
  // Measures the objects and allocates; before the loop. Both must outlive this object.
  FaultState(ControlSets& sets, const Catalog& catalog);

  void watch(std::uint64_t tick, SafetyLevel level) noexcept {
    const bool rises = level >= SafetyLevel::hold && level_ < SafetyLevel::hold;
    level_ = level;
    if (rises) keep(tick);
  }
  void pass_state(auto& bytes) noexcept { bytes(level_); }  // what was kept is none
  // "tick", and "object NAME" for each object: its bytes as hexadecimal digits. Empty: there was no fault yet. A fault
  // that comes during this call is not kept.
  TextMap facts() const;

 private:
  void keep(std::uint64_t tick) noexcept;

  ControlSets& sets_;
  const Catalog& catalog_;
  SafetyLevel level_ = SafetyLevel::normal;
  std::vector<std::vector<std::byte>> bytes_;  // by object
  std::uint64_t tick_ = 0;
  bool known_ = false;
  mutable std::atomic<bool> busy_{false};  // one thread is at what is kept
};

}  // namespace kadans
