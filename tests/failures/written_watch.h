// What may never be written to a plant, whatever goes wrong; looked at in every tick, field by field:
//
//   finite        effort, position and velocity, whether the mode uses them or not
//   torque        within the joint's limit, and with the measured speed within its power
//   torque rate   what was written last and the rate's step; a limit that became narrower may take torque at once, and
//                 so may the spring of a soft stop, damping, and being off
//   set-points    in the drive's own modes: position within the limits, speed within its limit, none beyond a stop
//   stops         no torque further out beyond a position limit, but damping
//   rungs         a joint that damps is braked at most; one that is off, or passive, has no torque
//
// Limits hold to `tolerance` of themselves, for rounding.
#pragma once

#include <string>
#include <vector>

#include "safety/safety.h"

namespace kadans::failures {

class WrittenWatch {
 public:
  static constexpr double tolerance = 1e-9;

  explicit WrittenWatch(const RobotModel& model) : model_(model), last_Nm_(model.joints.size()) {}

  void look(std::uint64_t tick, double dt_s, const ActuationFrame& written, const JointStates& measured,
            const Safety& safety);
  // The first thing that was broken; "" when nothing was.
  const std::string& broken() const noexcept { return broken_; }

 private:
  struct Seen {
    const JointActuation& written;
    const JointState& state;
    const JointLimits& limits;
    SafetyLevel level;
    double last_Nm, dt_s, damping_Nms_per_rad, stiffness_Nm_per_rad;
  };
  static const char* wrong_with(const Seen& seen);
  static bool within_rate(const Seen& seen);
  static bool brakes(const Seen& seen);

  const RobotModel& model_;
  std::vector<double> last_Nm_;
  std::string broken_;
};

}  // namespace kadans::failures
