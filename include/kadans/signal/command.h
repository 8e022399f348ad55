// Commands: how a behavior configures the control engine. A transaction is a header followed by its commands; it goes
// through the queue in one piece and is applied whole, in one tick, or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "kadans/exchange/ring.h"
#include "kadans/signal/capacity.h"
#include "kadans/signal/fault.h"

namespace kadans {

enum class CommandKind : std::uint8_t {
  transaction,    // header: `count` commands follow, `sequence` is its number from 1, `time_ns` when it was made
  set_parameter,  // index = ParameterId, value
  set_point,      // index = SetpointId, value to be reached in duration_s (0 = at once)
  cancel_motion,  // index = SetpointId: comes to rest where its motion is now
  switch_set,     // index = control set
  clear_faults,
  trapezoid,  // index = SetpointId, value to be reached in duration_s (0 = as soon as possible); velocity and
              // acceleration are limits
  via_point,  // index = SetpointId, value to be passed duration_s after the point before; count = its number, 0 begins
  order_drive,  // index = joint, count = DriveOrder; of persons alone
};

struct Command {
  CommandKind kind = CommandKind::transaction;
  std::uint32_t index = 0;
  std::uint32_t count = 0;
  std::uint32_t sequence = 0;
  alignas(8) std::int64_t time_ns = 0;
  double value = 0;
  double duration_s = 0;
  double velocity = 0, acceleration = 0;  // in the set-point's unit, per s and per s2
};
static_assert(std::is_trivially_copyable_v<Command>);
static_assert(sizeof(Command) == 56 && alignof(Command) == 8 && offsetof(Command, time_ns) == 16,
              "the same on 32-bit machines");

inline constexpr double motion_duration_max_s = 3600;

using CommandQueue = Ring<Command, command_capacity>;

// Why the control engine refused a transaction: the command that was wrong, and what was wrong with it. The newest
// refusals are in the snapshot, so that the sender learns of them.
enum class RefusalReason : std::uint8_t {
  none,
  malformed,     // not a known kind of command
  unknown,       // a parameter, set-point or control set that does not exist
  out_of_range,  // of the parameter or set-point, or not finite
  motion,        // wrong duration or limits, or the set-point cannot be led along a motion
  too_old,       // the whole transaction
  robot_held,
  joint_held,
};

struct alignas(8) Refusal {
  std::uint32_t sequence = 0;  // the transaction's number; 0: none
  CommandKind kind = CommandKind::transaction;
  RefusalReason reason = RefusalReason::none;
  std::uint16_t joint = no_joint;  // the one that is held
  std::uint32_t index = 0;         // as in the command
  alignas(8) double value = 0;     // as in the command
};
static_assert(std::is_trivially_copyable_v<Refusal> && sizeof(Refusal) == 24);

inline constexpr std::uint32_t refusals_shown = 8;

}  // namespace kadans
