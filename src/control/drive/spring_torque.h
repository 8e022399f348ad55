// Torque control of series elastic drives: an inner loop around the spring's deflection turns the wanted joint torque
// into the motor's torque (spring_torque_loop.h). Type "spring_torque".
//
// It is an actuator-level object (control_sets.h), not part of a control set: "drives" in the robot's configuration
// names it. It works on the actuation after composition and the safety layer, in the tick in which the state was
// measured. So the outer loops that compute torques stay as they are, and the inner loop's delay is that of the plant
// alone. A joint that is not in effort mode is left to its drive.
//
// Joints      with a spring in their drives.
// Parameters  <joint>. spring_Nm_per_rad, rotor_inertia_kg_m2 (the loop's model; the drive's own values unless given),
//             bandwidth_Hz, damping_ratio, rate_cutoff_Hz, observer_Hz, and share: 0 gives the motor the wanted torque,
//             1 closes the loop.
// Signals     SpringTorqueLoop::State of each joint, without its rate.
// Start       each time a joint comes back to effort mode: from the measured torque, with the disturbance at 0.
// Not finite  the motor gets the wanted joint torque.
#pragma once

#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "spring_torque_loop.h"

namespace kadans {

class SpringTorque final : public ControlObject {
 public:
  // Throws std::invalid_argument for a passive joint or one without a spring.
  explicit SpringTorque(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  // `actuation` holds the wanted joint torques; for its own joints they are replaced by motor torques.
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
