// Why the control engine refused a transaction: the command that was wrong, and what was wrong with it. The newest
// refusals are in the snapshot, so that the sender learns of them.
#pragma once

#include <cstdint>
#include <type_traits>

#include "kadans/signal/command.h"
#include "kadans/signal/fault.h"

namespace kadans {

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
