// A model of the temperature of a motor's winding, which is not measured: heat in proportion to the torque squared,
// lost through a first-order lag (I2t). At the continuous torque it settles at hot_C.
//
// One owner, the control thread; step neither allocates nor throws.
#pragma once

#include <algorithm>
#include <cmath>

#include "settings.h"

namespace kadans {

class ThermalModel {
 public:
  ThermalModel() = default;
  ThermalModel(const ThermalSettings& settings, double continuous_Nm, double time_constant_s) noexcept
      : ambient_C_(settings.ambient_C),
        heating_C_per_Nm2_((settings.hot_C - settings.ambient_C) / (continuous_Nm * continuous_Nm)),
        rate_per_s_(1 / time_constant_s),
        temperature_C_(settings.ambient_C) {}

  // A torque that is not finite counts as 0. dt_s must be well below the time constant.
  void step(double effort_Nm, double dt_s) noexcept {
    const double heat_C = heating_C_per_Nm2_ * effort_Nm * effort_Nm;
    const double settled_C = ambient_C_ + (std::isfinite(heat_C) ? heat_C : 0);
    temperature_C_ += std::min(1.0, rate_per_s_ * dt_s) * (settled_C - temperature_C_);
  }

  const double& temperature_C() const noexcept { return temperature_C_; }

 private:
  double ambient_C_ = 0;
  double heating_C_per_Nm2_ = 0;
  double rate_per_s_ = 0;
  double temperature_C_ = 0;
};

}  // namespace kadans
