// Series elastic drives as drives of torque: turns the torque wanted at each joint into that of its motor, by a loop
// around the spring's deflection (spring_torque_loop.h). Type "spring_torque".
//
// It stands at the drives, not in control sets: "drives" in the robot's configuration names it, and it works on what is
// left after composition and safety, in the tick that the state was measured in. So what computes torques outside of it
// stays as it is, and its delay is the plant's alone. A joint that is not in effort mode is left to its drive.
//
// Joints      with a spring in their drives.
// Parameters  <joint>. spring_Nm_per_rad, rotor_inertia_kg_m2 (as the loop believes them to be; the drive's own unless
//             given), bandwidth_Hz, damping_ratio, rate_cutoff_Hz, observer_Hz, and share: 0 hands on what is
//             wanted, 1 closes the loop.
// Signals     SpringTorqueLoop::State of each joint.
// Start       whenever a joint comes back to effort mode: from the measured torque, without a disturbance.
// Not finite  the motor gets what is wanted of the joint.
#pragma once

#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/spring_torque_loop.h"

namespace kadans {

class SpringTorque final : public ControlObject {
 public:
  // Throws std::invalid_argument for a passive joint or one without a spring.
  explicit SpringTorque(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  // `actuation` holds the torques wanted at the joints; those of its own it replaces.
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void rehearse(const ControlInput& input) const noexcept override;
  void set_point(std::uint32_t, double, double) noexcept override {}  // has none
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }
  void parameters_changed() noexcept override;

 private:
  struct Part {
    JointAxis axis;
    SpringTorqueLoop loop{};
    double share = 1;
  };
  void declare(Declaration& declaration, Part& part);

  std::vector<Part> parts_;
};

std::unique_ptr<ControlObject> make_spring_torque(const ObjectSetup& setup);

}  // namespace kadans
