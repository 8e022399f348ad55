// An amplifier that takes a PWM's duty for a current, a voltage or a velocity, and the motor with its gear behind it.
//
//   effort = Nm_per_A gear efficiency I            at the joint, seen from the drive
//   current amplifier    I = duty full
//   voltage amplifier    duty full = I Ohm + Nm_per_A gear w      (Nm/A = Vs/rad)
//   velocity amplifier   effort = gain (duty full / gear - w)     its own loop, of that gain at the joint
//
// The torque is open loop: its error is that of these constants, and of friction in the gear beyond the efficiency.
#pragma once

#include <algorithm>
#include <cmath>

namespace kadans::hostmot2 {

struct AmplifierSettings {
  enum class Kind : unsigned char { current, voltage, velocity };
  Kind kind = Kind::current;
  double full = 1;              // A, V, or rad/s of the motor, at full duty
  double current_max_A = 1;     // never more than this
  double gain_Nms_per_rad = 1;  // > 0, of a velocity amplifier's own loop
  double winding_Ohm = 1;       // of a voltage amplifier's motor
  double Nm_per_A = 1;          // of the motor's own shaft
  double gear = 1;              // turns of the motor for one of the joint, > 0
  double efficiency = 1;        // of the gear, 0..1
};

class Amplifier {
 public:
  explicit Amplifier(const AmplifierSettings& settings) noexcept
      : settings_(settings),
        Nm_per_A_(settings.Nm_per_A * settings.gear * settings.efficiency),
        Vs_per_rad_(settings.Nm_per_A * settings.gear) {}

  struct Duty {
    double duty = 0;       // -1..1
    double effort_Nm = 0;  // that follows from it
    bool limited = false;  // less than was asked for
  };
  // Not a number is no torque.
  Duty duty_for(double effort_Nm, double velocity_rad_s) const noexcept {
    if (!std::isfinite(effort_Nm) || !std::isfinite(velocity_rad_s)) return {.limited = true};
    const double asked_A = effort_Nm / Nm_per_A_;
    double current_A = std::clamp(asked_A, -settings_.current_max_A, settings_.current_max_A);
    double duty = 0;
    if (settings_.kind == AmplifierSettings::Kind::current) {
      duty = std::clamp(current_A / settings_.full, -1.0, 1.0);
      current_A = duty * settings_.full;
    } else if (settings_.kind == AmplifierSettings::Kind::velocity) {
      const double asked_rad_s = velocity_rad_s + Nm_per_A_ * current_A / settings_.gain_Nms_per_rad;
      duty = std::clamp(asked_rad_s * settings_.gear / settings_.full, -1.0, 1.0);
      current_A = settings_.gain_Nms_per_rad * (duty * settings_.full / settings_.gear - velocity_rad_s) / Nm_per_A_;
    } else {
      const double back_V = Vs_per_rad_ * velocity_rad_s;
      duty = std::clamp((current_A * settings_.winding_Ohm + back_V) / settings_.full, -1.0, 1.0);
      current_A = (duty * settings_.full - back_V) / settings_.winding_Ohm;
    }
    return {.duty = duty,
            .effort_Nm = Nm_per_A_ * current_A,
            .limited = std::abs(current_A - asked_A) > 1e-9 * settings_.current_max_A};
  }

 private:
  AmplifierSettings settings_;
  double Nm_per_A_, Vs_per_rad_;
};

}  // namespace kadans::hostmot2
