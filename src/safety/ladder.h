// Where one joint, or the robot, stands on the degradation ladder, and why.
//
// Going down is immediate: each fault asks for a rung and the worst counts. A rung is left when its faults have been
// over for their exit time, so that a value that flickers about its limit makes one fault and not a thousand. A rung
// that is latched stays until it is cleared.
//
// One owner, the control thread; nothing here allocates or throws.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "kadans/signal/fault.h"
#include "kadans/signal/status.h"

namespace kadans {

// A set of fault codes, one bit each: what a watch found in a tick.
using FaultMask = std::uint64_t;
static_assert(fault_codes <= 64);

constexpr FaultMask bit(FaultCode code) noexcept { return FaultMask{1} << static_cast<unsigned>(code); }
constexpr FaultMask bit_if(bool condition, FaultCode code) noexcept { return condition ? bit(code) : 0; }
// For what runs for every joint: mostly nothing is wrong, and on 32 bits a branch is less work than a mask of 64.
[[gnu::always_inline]] constexpr void note_if(bool condition, FaultCode code, FaultMask& found) noexcept {
  if (condition) [[unlikely]]
    found |= bit(code);
}
// Of a mask that is not empty.
constexpr FaultCode first_of(FaultMask mask) noexcept { return static_cast<FaultCode>(std::countr_zero(mask)); }

// What was seen, and what was allowed.
inline void tell(Fault& fault, double value, double limit) noexcept {
  fault.value = value;
  fault.limit = limit;
}

// The reaction to a fault: the rungs of the ladder that it asks for, and how they are left again. Each fault code has a
// reaction, and each reaction is a key of the robot's configuration.
//
// The ladder:  normal   everything goes on
//              limited  a command was reduced, or something is reported that has no effect yet
//              hold     the control set keeps its last set-points, a motion under way goes on to its end; commands that
//                       would change what is asked of the joint, or of any joint when the robot holds, are refused
//              damp     every torque is -damping times velocity
//              off      no torque
// A joint is on the worse of its own rung and the robot's.
struct Reaction {
  SafetyLevel joint = SafetyLevel::normal;  // of the joint concerned, if there is one
  SafetyLevel robot = SafetyLevel::normal;
  bool latch = false;     // the rung stays until faults are cleared; else it is left when the fault is over for exit_s
  bool escalate = false;  // while it lasts the robot goes on: after hold_s from hold to damp, after damp_s to off,
                          // and both stay until cleared
  double exit_s = 0.05;   // how long the fault must be over before its rung is left
};

using Reactions = std::array<Reaction, fault_codes>;  // by fault code

// A joint whose own limit or actuation failed damps. A joint that is not measured any more is off, because damping
// needs its velocity. Without an IMU or a heartbeat the robot holds.
Reactions default_reactions() noexcept;

class Ladder {
 public:
  // `faults`: all faults of this tick. `rung` picks the joint's or the robot's part of a reaction. Returns the faults
  // that are new.
  FaultMask update(FaultMask faults, double dt_s, const Reactions& reactions, SafetyLevel Reaction::*rung) noexcept;
  // Goes down to `level` until cleared.
  void latch(SafetyLevel level) noexcept;
  void clear() noexcept { *this = {}; }

  SafetyLevel level() const noexcept { return level_; }
  // Nothing is wrong, was wrong lately or is latched: update(0) would change nothing.
  bool idle() const noexcept { return idle_; }
  void pass_state(auto& bytes) noexcept {
    bytes(left_s_, reported_, latched_faults_, latched_, level_, idle_);
    bytes.must(latched_ <= SafetyLevel::off && level_ <= SafetyLevel::off);
  }

 private:
  void settle() noexcept;

  std::array<double, 5> left_s_{};       // by rung: until it may be left
  std::array<FaultMask, 5> reported_{};  // by rung: faults of the present episode
  FaultMask latched_faults_ = 0;
  SafetyLevel latched_ = SafetyLevel::normal;
  SafetyLevel level_ = SafetyLevel::normal;
  bool idle_ = true;
};

}  // namespace kadans
