// A position loop with an inner velocity loop on each joint, in effort mode: type "joint_cascade". This is the
// classical structure of a servo (Leonhard, Control of Electrical Drives, 3rd ed., ch. 15). Each loop has a limit of
// its own, so the joint never gets a velocity command beyond velocity_max on a long way.
//
//   v_cmd = limit(v_ref + kp (q_ref - q), +-velocity_max)
//   u     = limit(feedforward + inertia a_ref + kv (v_cmd - v) + I, +-effort_max),   dI/dt = ki (v_cmd - v)
//
// The reference's velocity and acceleration come from the motion, never from differences. Only the inner loop
// integrates, and the outer loop cannot wind it up: its command is limited before the integral sees it. The integral
// does not grow in the direction in which u is limited, nor beyond integral_max.
//
// Set-points  <joint>.position_rad, reached by a minimum-jerk motion in the time given.
// Start       the reference continues with the joint's velocity and comes to rest; the integral takes over the torque
//             from before.
#pragma once

#include <memory>

#include "kadans/control/position_reference.h"

namespace kadans {

class CascadeLaw : public PositionReference {
 public:
  struct Config {
    double kp_per_s = 0;         // 0..200
    double kv_Nms_per_rad = 0;   // 0..500
    double ki_Nm_per_rad = 0;    // 0..50000: torque per time integral of the velocity error
    double inertia_kg_m2 = 0;    // 0..10: feed-forward of the reference's acceleration
    double velocity_weight = 1;  // 0..1: feed-forward of the reference's velocity
    double feedforward_Nm = 0;   // within +-effort_max of the joint
    double integral_max_Nm = 0;
    double velocity_max_rad_s = 0;
    double effort_max_Nm = 0;
  };
  struct State {
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double error_rad = 0;
    double velocity_command_rad_s = 0;  // of the outer loop, limited
    double integral_Nm = 0;
    double effort_Nm = 0;
    bool velocity_limited = false;
    bool saturated = false;
  };

  explicit CascadeLaw(const JointAxis& axis) : PositionReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    PositionReference::pass_state(bytes);
    bytes(state_);
  }

 private:
  double velocity_command(const MinimumJerk::State& reference, double position_rad) noexcept;

  Config config_;
  State state_;
};

std::unique_ptr<ControlObject> make_joint_cascade(const ObjectSetup& setup);

}  // namespace kadans
