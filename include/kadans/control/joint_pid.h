// PID on one joint or many, in effort mode, each with a set-point that moves smoothly: type "joint_pid".
//
// Set-points  <joint>.position_rad (within the joint's limits), reached by a minimum-jerk motion in the time given.
// Parameters  a Pid::Config a joint: <joint>.kp_Nm_per_rad and so on.
// Signals     a Pid::State a joint: <joint>.reference_rad and so on.
#pragma once

#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/control/pid.h"

namespace kadans {

class JointPid final : public ControlObject {
 public:
  // Throws std::invalid_argument for a passive joint.
  explicit JointPid(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override;
  void cancel_motion(std::uint32_t channel) noexcept override;
  double motion_remaining_s() const noexcept override;

 private:
  struct Axis {
    std::size_t joint;
    std::string name;
    double lower_rad, upper_rad, effort_max_Nm;
    MinimumJerk reference;
    Pid pid;
  };
  std::vector<Axis> axes_;
};

std::unique_ptr<ControlObject> make_joint_pid(const ObjectSetup& setup);

}  // namespace kadans
