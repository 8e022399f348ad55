// Fault codes: what went wrong, where and when. A fault names the limit behind it, so that a person can look it up.
#pragma once

#include <cstddef>
#include <cstdint>

namespace kadans {

enum class FaultCode : std::uint16_t {
  none,
  position_limit,        // a joint passed its limit
  velocity_limit,        // a joint was faster than its limit
  effort_limit,          // a control object asked for more torque than the joint may have: limited
  actuation_not_finite,  // a control object wrote NaN or infinity: the joint damps
  sensor_not_finite,     // a sensor delivered NaN or infinity
  sensor_silent,         // a sensor delivered no new reading
  heartbeat_lost,        // the behavior engine stopped ticking
  tick_overrun,          // a tick of the control engine came late
  command_refused,       // a command was not finite, out of range, unknown or too old
};
const char* name(FaultCode code) noexcept;

inline constexpr std::uint16_t no_joint = 0xffff;

struct Fault {
  FaultCode code = FaultCode::none;
  std::uint16_t joint = no_joint;     // index in the model, or no_joint
  alignas(8) std::uint64_t tick = 0;  // of the control engine
  double value = 0;                   // what was seen
  double limit = 0;                   // what was allowed
};
static_assert(sizeof(Fault) == 32 && alignof(Fault) == 8 && offsetof(Fault, tick) == 8, "the same on 32-bit machines");

}  // namespace kadans
