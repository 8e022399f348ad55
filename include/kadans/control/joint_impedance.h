// A spring and a damper between each joint and its reference, with a torque of its own beside them, in effort mode:
// type "joint_impedance" (Hogan 1985, Impedance Control, J. Dyn. Sys. Meas. Control 107; part I, without shaping the
// inertia).
//
//   u = limit(effort_ref + K (q_ref - q) + D (v_ref - v), +-effort_max)
//
// No integral: what pushes the joint meets the spring, however long it pushes. The load is carried by effort_ref.
//
// Set-points  <joint>.position_rad and <joint>.effort_Nm, each reached along a minimum-jerk curve in the time given.
// Start       the reference goes on with the joint's velocity and comes to rest; effort_ref is the torque that was
// there,
//             and stays until it is set.
#pragma once

#include <memory>

#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"

namespace kadans {

class ImpedanceLaw {
 public:
  struct Config {
    double stiffness_Nm_per_rad = 0;  // 0..5000
    double damping_Nms_per_rad = 0;   // 0..500
    double effort_max_Nm = 0;
  };
  struct State {
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double reference_effort_Nm = 0;
    double deflection_rad = 0;  // reference minus position
    double effort_Nm = 0;
    bool saturated = false;
  };
  static constexpr std::uint32_t channels = 2;

  explicit ImpedanceLaw(const JointAxis& axis) : axis_(axis) {}
  void declare(AxisTables& tables);
  void start(const Handover& handover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void set_point(std::uint32_t which, double value, double duration_s) noexcept;
  void cancel(std::uint32_t which) noexcept;
  double remaining_s() const noexcept;

 private:
  JointAxis axis_;
  Config config_;
  State state_;
  MinimumJerk reference_, effort_;  // channels 0 and 1
};

std::unique_ptr<ControlObject> make_joint_impedance(const ObjectSetup& setup);

}  // namespace kadans
