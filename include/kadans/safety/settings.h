// Limits and reactions of the safety layer; every field is a key of the robot's configuration.
#pragma once

#include <cstdint>
#include <vector>

namespace kadans {

struct JointLimits {
  double lower_rad = 0, upper_rad = 0;
  double velocity_max_rad_s = 0;
  double effort_max_Nm = 0;  // 0: passive, never actuated
};

struct SafetySettings {
  std::vector<JointLimits> joints;        // one a joint
  double position_margin_rad = 0.05;      // beyond a limit before it is a fault
  double velocity_margin = 1.5;           // times the limit before it is a fault
  double damping_Nms_per_rad = 2.0;       // of a joint that damps
  double heartbeat_timeout_s = 0.1;       // of the behavior engine
  std::uint32_t silent_ticks_max = 5;     // readings missing in a row before a sensor counts as silent
  std::uint32_t overruns_in_a_row_max = 5;
  double hold_s = 1.0;                    // after a lost heartbeat: hold this long, then damp
  double damp_s = 2.0;                    // damp this long, then off
};

}  // namespace kadans
