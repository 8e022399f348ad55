// A spring and a damper between a joint and its reference, plus a given torque, all within a bound:
//
//   u = limit(effort + K (q_ref - q) + D (v_ref - v), +-effort_max)
//
// The law is computed here, once a tick, or by the drive (impedance mode), at the drive's own rate and without the
// delay of the bus. In the drive the bound applies to the given torque alone, and the drive's own limit to the sum.
//
// One owner, the control thread; step() neither allocates, locks nor throws.
#pragma once

#include "kadans/control/joint_axis.h"
#include "kadans/signal/frames.h"

namespace kadans {

class SpringDamper {
 public:
  struct Config {
    double stiffness_Nm_per_rad = 0;  // 0..5000
    double damping_Nms_per_rad = 0;   // 0..500
    double effort_max_Nm = 0;
  };
  struct State {
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double error_rad = 0;  // reference minus position
    double effort_Nm = 0;
    bool saturated = false;
  };
  // The names that a law gives to its parameters and its signal.
  struct Names {
    const char* stiffness;
    const char* damping;
    const char* error;
  };

  void declare(AxisTables& tables, const Names& names);
  void compute_in_drive(bool in_drive) noexcept { in_drive_ = in_drive; }  // before the loop
  void start(double effort_Nm) noexcept;
  JointActuation step(double reference_rad, double reference_velocity_rad_s, double effort_Nm,
                      const JointState& joint) noexcept;
  void pass_state(StateBytes& bytes) noexcept { bytes(state_); }

 private:
  Config config_;
  State state_;
  bool in_drive_ = false;
};

}  // namespace kadans
