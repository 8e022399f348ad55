// Joint velocity from joint position: the difference quotient through a second-order Butterworth low pass.
//
// The low pass is the bilinear transform of the analogue filter, prewarped at the cut-off, in the form with two
// trapezoidal integrators (Zavalishin, The Art of VA Filter Design, section 4): its two states keep their meaning when
// the step changes, so a late tick needs no special case. When readings were missing the quotient over the whole gap is
// fed in once for each missing step, as if the joint had moved evenly. The price of smoothness is delay: at low
// frequencies sqrt(2) / (2 pi cut-off), 2.25 ms at 100 Hz, and half a sampling period for the quotient.
//
// One owner, the control thread. update neither allocates nor throws.
#pragma once

#include <cmath>

namespace kadans {

class VelocityFilter {
 public:
  struct Config {
    double cutoff_Hz = 100;  // where the gain is -3 dB; inside (0, 0.45 / dt_s)
    double dt_s = 0.001;     // nominal sampling period, > 0
  };
  struct State {
    double position_rad = 0;    // the last reading
    double quotient_rad_s = 0;  // not filtered
    double velocity_rad_s = 0;  // filtered
  };

  explicit VelocityFilter(const Config& config);  // throws std::invalid_argument naming field, value and range

  // The delay of the velocity of an evenly accelerated joint.
  static double delay_s(const Config& config) noexcept;

  // False, and nothing changes, outside (0, 0.45 / dt_s).
  [[nodiscard]] bool set_cutoff(double cutoff_Hz) noexcept;

  // elapsed_s: since the last reading, > 0. Returns the velocity. The first reading after construction or reset gives
  // 0, whatever the position. A position or time that is not finite, or no time at all, changes nothing.
  double update(double position_rad, double elapsed_s) noexcept {
    if (elapsed_s == step_s_ && elapsed_s == config_.dt_s && started_ && std::isfinite(position_rad)) {  // mostly
      take(position_rad, elapsed_s);
      pass();
    } else {
      update_unevenly(position_rad, elapsed_s);
    }
    return state_.velocity_rad_s;
  }

  // At rest; the next reading is a first one.
  void reset() noexcept;

  const Config& config() const noexcept { return config_; }
  const State& state() const noexcept { return state_; }
  void pass_state(auto& bytes) noexcept { bytes(state_, step_s_, a1_, a2_, a3_, band_rad_s_, low_rad_s_, started_); }

 private:
  void prewarp() noexcept;  // for the cut-off
  void set_step(double step_s) noexcept;
  void update_unevenly(double position_rad, double elapsed_s) noexcept;
  void take(double position_rad, double elapsed_s) noexcept {
    state_.quotient_rad_s = (position_rad - state_.position_rad) / elapsed_s;
    state_.position_rad = position_rad;
  }
  void pass() noexcept {  // the quotient through one step of the low pass
    const double high = state_.quotient_rad_s - low_rad_s_;
    const double band = a1_ * band_rad_s_ + a2_ * high;
    const double low = low_rad_s_ + a2_ * band_rad_s_ + a3_ * high;
    band_rad_s_ = 2 * band - band_rad_s_;
    low_rad_s_ = 2 * low - low_rad_s_;
    state_.velocity_rad_s = low;
  }

  Config config_;
  State state_;
  double nominal_gain_ = 0,
         gain_slope_per_s_ = 0;            // of an integrator: tan(pi cut-off step), and how it grows with step
  double step_s_ = 0;                      // that the coefficients are made for
  double a1_ = 0, a2_ = 0, a3_ = 0;        // coefficients
  double band_rad_s_ = 0, low_rad_s_ = 0;  // the integrators
  bool started_ = false;
};

}  // namespace kadans
