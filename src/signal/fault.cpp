#include "kadans/signal/fault.h"

#include "kadans/signal/status.h"

namespace kadans {

const char* name(FaultCode code) noexcept {
  switch (code) {
    case FaultCode::none:
      return "none";
    case FaultCode::position_limit:
      return "position_limit";
    case FaultCode::velocity_limit:
      return "velocity_limit";
    case FaultCode::effort_limit:
      return "effort_limit";
    case FaultCode::actuation_not_finite:
      return "actuation_not_finite";
    case FaultCode::sensor_not_finite:
      return "sensor_not_finite";
    case FaultCode::sensor_silent:
      return "sensor_silent";
    case FaultCode::heartbeat_lost:
      return "heartbeat_lost";
    case FaultCode::tick_overrun:
      return "tick_overrun";
    case FaultCode::command_refused:
      return "command_refused";
  }
  return "unknown";
}

const char* name(SafetyLevel level) noexcept {
  switch (level) {
    case SafetyLevel::normal:
      return "normal";
    case SafetyLevel::limited:
      return "limited";
    case SafetyLevel::hold:
      return "hold";
    case SafetyLevel::damp:
      return "damp";
    case SafetyLevel::off:
      return "off";
  }
  return "unknown";
}

}  // namespace kadans
