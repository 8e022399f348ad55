// A spring and a damper between a point of a limb and its reference, in effort mode: type "task_impedance" (Hogan 1985,
// Impedance Control, J. Dyn. Sys. Meas. Control 107, without shaping the inertia; Khatib 1987, IEEE J. Robotics and
// Automation 3(1), for J^T).
//
//   F = K (x_ref - x) + D (v_ref - v), its length limited to force_max
//   u = limit(J^T F + posture (q_start - q) - damping qd + I, +-effort_max)
//
// x is the position of the point, v = J qd its velocity, J its Jacobian, all in the base frame. Each tick computes them
// along the limb's own joints. Passive joints of the limb and joints that other objects drive count for x and v, too.
// The point leaves some motions free (a leg's foot may turn). The springs and dampers of the joints hold these; the
// springs hold the pose of the start, so they also act on the point. Gravity is not compensated: compose with a
// gravity_compensation ("sum").
//
// Options     link: the link that the point belongs to; required.
// Set-points  x_m, y_m, z_m: of the point, in the base frame; reached by a minimum-jerk motion in the time given.
// Parameters  point_x_m, point_y_m, point_z_m: the point in the link's frame (a new point is taken over as at the
//             start); a Config per direction: x.stiffness_N_per_m and so on; force_max_N; a JointConfig per joint.
// Signals     a State per direction, a JointOutput per joint, force_limited.
// Start       the reference is where the point is. Torque that the law does not explain fades within 0.2 s.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops. While any
//             joint of the limb is not measured, the position of the point is unknown: F is 0, and the reference is
//             taken anew afterwards.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/limb_chain.h"

namespace kadans {

class TaskImpedance final : public ControlObject {
 public:
  struct Config {                  // of a direction
    double stiffness_N_per_m = 0;  // 0..50000
    double damping_Ns_per_m = 0;   // 0..5000
  };
  struct State {  // of a direction
    double reference_m = 0;
    double position_m = 0;
    double error_m = 0;
    double force_N = 0;
  };
  struct JointConfig {
    double posture_Nm_per_rad = 0;   // 0..5000
    double damping_Nms_per_rad = 0;  // 0..500
    double effort_max_Nm = 0;        // 0..the joint's
  };
  struct JointOutput {
    double effort_Nm = 0;
    bool saturated = false;
  };

  // Throws std::invalid_argument for a passive joint, a missing or unknown link, and a joint that does not move it.
  explicit TaskImpedance(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  void parameters_changed() noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;

 private:
  struct Direction {
    Config config;
    State state;
    SetpointState reference;
  };
  struct Part {
    JointAxis axis;
    std::size_t segment = 0;  // of the chain
    JointConfig config;
    JointOutput output;
    double posture_rad = 0;
    EffortTakeover takeover;
  };
  void declare_direction(Declaration& declaration, std::size_t direction);
  void declare_joint(Declaration& declaration, Part& part);
  bool measured(const JointStates& joints) const noexcept;
  void take_over_point(const JointStates& joints) noexcept;
  void pull(const JointStates& joints) noexcept;
  double law_Nm(const Part& part, const JointState& joint) const noexcept;

  LimbChain chain_;
  std::vector<Part> parts_;
  std::array<Direction, 3> directions_;
  Vec3 point_in_link_m_{};
  Vec3 point_started_m_{};  // point_in_link_m_ when the reference was taken
  double force_max_N_ = 0;
  bool force_limited_ = false;
  bool located_ = false;  // the reference was taken from a known position of the point
};

std::unique_ptr<ControlObject> make_task_impedance(const ObjectSetup& setup);

}  // namespace kadans
