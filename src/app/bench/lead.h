// Leads a joint by its encoder: a spring and a damper to a place that moves slowly, by the model's inertia. `relation`:
// whether a positive effort makes its encoder count up, +1 or -1.
#pragma once

#include <algorithm>
#include <cmath>

#include "push.h"

namespace kadans {

class Lead final : public Push {
 public:
  struct Settings {
    std::size_t joint = 0;
    double relation = 1;
    double inertia_kg_m2 = 1, effort_max_Nm = 0;
    double way_rad = 0.05;        // from where it stands, as its encoder counts
    double speed_rad_s = 0.05;    // of the place
    double bandwidth_rad_s = 15;  // of spring and inertia
    double stays_s = 1;           // there, before it is complete
    double behind_rad = 0.018;    // further behind the place for a while, it is blocked
    bool seeks_stop = false;      // complete when it is blocked
  };
  explicit Lead(const Settings& settings) : settings_(settings) {}

  void begin(const BenchSight& sight) override {
    start_rad_ = place_rad_ = sight.position_rad[settings_.joint];
    integral_Nm_ = stayed_s_ = behind_s_ = 0;
    begun_s_ = sight.time_s;
  }
  double step(const BenchSight& sight) override {
    const Settings& s = settings_;
    last_rad_ = sight.position_rad[s.joint];
    if (sight.time_s - begun_s_ < 0.1) return 0;  // the drive is enabled
    const double goal_rad = start_rad_ + s.way_rad;
    const double most_rad = s.speed_rad_s * sight.dt_s;
    const double moved_rad = std::clamp(goal_rad - place_rad_, -most_rad, most_rad);
    place_rad_ += moved_rad;
    if (std::abs(goal_rad - place_rad_) < 1e-9) stayed_s_ += sight.dt_s;
    const bool behind = std::abs(place_rad_ - sight.position_rad[s.joint]) > s.behind_rad;
    behind_s_ = behind ? behind_s_ + sight.dt_s : 0;
    const double stiffness = s.inertia_kg_m2 * s.bandwidth_rad_s * s.bandwidth_rad_s;
    const double damping = 2 * s.inertia_kg_m2 * s.bandwidth_rad_s;
    const double error_rad = place_rad_ - sight.position_rad[s.joint];
    const double faster_rad_s = moved_rad / sight.dt_s - sight.velocity_rad_s[s.joint];
    integral_Nm_ += stiffness * s.bandwidth_rad_s / 5 * error_rad * sight.dt_s;
    integral_Nm_ = std::clamp(integral_Nm_, -s.effort_max_Nm, s.effort_max_Nm);
    effort_Nm_ =
        std::clamp(stiffness * error_rad + damping * faster_rad_s + integral_Nm_, -s.effort_max_Nm, s.effort_max_Nm);
    return s.relation * effort_Nm_;
  }
  // Goes on to another place, without letting go; rad from where it stood at its begin.
  void go_on(double way_rad) noexcept {
    settings_.way_rad = way_rad;
    stayed_s_ = 0;
  }
  bool complete() const override { return stayed_s_ >= settings_.stays_s || (settings_.seeks_stop && blocked()); }
  bool blocked() const noexcept { return behind_s_ > 0.7; }  // it does not follow
  double last_rad() const noexcept { return last_rad_; }     // where it was in the last tick
  double place_rad() const noexcept { return place_rad_ - start_rad_; }
  // How far its encoder went.
  double went_rad(const BenchSight& sight) const noexcept { return sight.position_rad[settings_.joint] - start_rad_; }

 private:
  Settings settings_;
  double start_rad_ = 0, place_rad_ = 0, integral_Nm_ = 0, stayed_s_ = 0, behind_s_ = 0, begun_s_ = 0, effort_Nm_ = 0,
         last_rad_ = 0;
};

}  // namespace kadans
