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
  arm,        // the `count` commands behind it, of which the first `index` are conditions, wait in the control engine;
              // sequence = ArmOptions, duration_s = for how long they wait
  condition,  // of an arm: count = ConditionKind, time_ns = signal_key() or index = SetpointId, value
  reset_odometry,  // from the next tick on the base is at 0, with a heading of 0
  disarm,          // takes back: sequence = number of the transaction, index = which of its arms, from 0
};

// When the commands behind an arm are carried out: in the tick in which its conditions become true.
enum class ConditionKind : std::uint8_t {
  above,    // the signal is greater than `value`
  below,    // the signal is less than `value`
  after,    // `value` seconds have passed since it was armed
  arrived,  // no set-point of the set-point's control object moves any more
};
inline constexpr ConditionKind last_condition_kind = ConditionKind::arrived;
enum ArmOptions : std::uint8_t {
  arm_any = 1,         // one condition suffices; else all must be true
  arm_every_time = 2,  // again each time that they become true; else once
};
inline constexpr std::size_t max_armed = 8;             // that wait at the same time
inline constexpr std::size_t max_armed_conditions = 4;  // of one
inline constexpr std::size_t max_armed_commands = 63;   // that one carries out

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
  armed_full,  // too many wait already
  set_dwells,  // a control set or object was switched too short a time ago
};

struct alignas(8) Refusal {
  std::uint32_t sequence = 0;  // the transaction's number; 0: none
  CommandKind kind = CommandKind::transaction;
  RefusalReason reason = RefusalReason::none;
  std::uint16_t joint = no_joint;  // the one that is held; set_dwells: the control set that dwells
  std::uint32_t index = 0;         // as in the command
  alignas(8) double value = 0;     // as in the command; set_dwells: for how long it still dwells, in s
};
static_assert(std::is_trivially_copyable_v<Refusal> && sizeof(Refusal) == 24);

inline constexpr std::uint32_t refusals_shown = 8;

// What became of an armed transaction. The status stays until its place is taken by another one: that which ended first
// goes first.
enum class ArmedState : std::uint8_t { none, waits, done, refused, expired, taken_back };

struct alignas(8) ArmedStatus {
  std::uint32_t sequence = 0;  // number of the transaction that armed it
  std::uint16_t which = 0;     // of the arms of that transaction, from 0
  ArmedState state = ArmedState::none;
  RefusalReason reason = RefusalReason::none;  // why it was refused when its conditions were true
  std::uint32_t fired = 0;                     // how often it was carried out
  std::uint32_t reserved = 0;
  std::uint64_t fired_tick = 0;  // the last time
};
static_assert(std::is_trivially_copyable_v<ArmedStatus> && sizeof(ArmedStatus) == 24);

}  // namespace kadans
