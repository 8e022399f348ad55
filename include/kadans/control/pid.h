// The PID law for one joint, in parallel form (Astrom and Hagglund, Advanced PID Control, ISA 2006, ch. 3):
//
//   u = feedforward + kp e + I + kd (b v_ref - v_f),   dI/dt = ki e,   e = reference - position
//
// The derivative acts on the measured velocity, low-passed at kd_cutoff. The reference's own velocity enters with the
// weight b; the motion delivers it exactly, it is never a difference. The integral is kept as a torque, so changing ki
// does not step u. Anti-windup: the integral does not grow in the direction in which u is limited, nor beyond
// integral_max. The output is limited to +-effort_max.
//
// One owner, the control thread; step() neither allocates, locks nor throws.
#pragma once

#include <algorithm>
#include <numbers>

#include "kadans/control/state_bytes.h"

namespace kadans {

class Pid {
 public:
  struct Config {
    double kp_Nm_per_rad = 0;    // 0..50000
    double ki_Nm_per_rads = 0;   // 0..50000
    double kd_Nms_per_rad = 0;   // 0..5000
    double kd_cutoff_Hz = 0;     // 0..1000; 0: no filter of its own
    double velocity_weight = 1;  // b, 0..1
    double integral_max_Nm = 0;  // >= 0
    double feedforward_Nm = 0;   // within +-effort_max
    double effort_max_Nm = 0;    // >= 0
  };
  struct State {
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double error_rad = 0;
    double integral_Nm = 0;
    double effort_Nm = 0;
    double velocity_rad_s = 0;  // measured, filtered
    bool saturated = false;
  };

  // Takes over at the measured state, with the reference at the same position. The integral is set so that the next
  // output is effort_Nm, as far as its limit allows.
  void start(double position_rad, double velocity_rad_s, double effort_Nm,
             double reference_velocity_rad_s = 0) noexcept;
  // Returns the effort. Values that are not finite give a result that is not finite; the safety layer stops it.
  double step(double reference_rad, double reference_velocity_rad_s, double position_rad, double velocity_rad_s,
              double dt_s) noexcept;

  Config& config() noexcept { return config_; }
  const Config& config() const noexcept { return config_; }
  const State& state() const noexcept { return state_; }
  void pass_state(StateBytes& bytes) noexcept { bytes(state_); }

 private:
  Config config_;
  State state_;
};

// Here, because it runs for every joint in every tick.
inline double Pid::step(double reference_rad, double reference_velocity_rad_s, double position_rad,
                        double velocity_rad_s, double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  s.reference_rad = reference_rad;
  s.reference_velocity_rad_s = reference_velocity_rad_s;
  s.error_rad = reference_rad - position_rad;

  if (c.kd_cutoff_Hz > 0) {  // first-order low pass by backward differences: stable for every cut-off
    const double rate = 2 * std::numbers::pi * c.kd_cutoff_Hz * dt_s;
    s.velocity_rad_s += rate / (1 + rate) * (velocity_rad_s - s.velocity_rad_s);
  } else {
    s.velocity_rad_s = velocity_rad_s;
  }

  const double unlimited_Nm = c.feedforward_Nm + c.kp_Nm_per_rad * s.error_rad + s.integral_Nm +
                              c.kd_Nms_per_rad * (c.velocity_weight * reference_velocity_rad_s - s.velocity_rad_s);
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;

  const double growth_Nm = c.ki_Nm_per_rads * s.error_rad * dt_s;
  const bool winds_up = s.saturated && growth_Nm * unlimited_Nm > 0;
  if (!winds_up) s.integral_Nm = std::clamp(s.integral_Nm + growth_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  return s.effort_Nm;
}

}  // namespace kadans
