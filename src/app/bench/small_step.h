// Carries a joint where it stands, holds it there with given gains, steps its place by a small angle and back, and
// looks how it answers. The loop is that of a control object: the velocity comes from the estimator's filter, and an
// effort is written a tick after it was computed. What carried the joint before is added.
//
// It lets go at once when the joint overshoots, when it goes too far, or when its effort goes up and down again and
// again.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "kadans/estimate/velocity_filter.h"
#include "lead.h"

namespace kadans {

class SmallStep final : public Push {
 public:
  struct Settings {
    std::size_t joint = 0;
    double inertia_kg_m2 = 1;
    double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0, effort_max_Nm = 0;
    double step_rad = 0.0175;
    double velocity_cutoff_Hz = 100, period_s = 1e-3;
  };
  explicit SmallStep(const Settings& settings)
      : settings_(settings),
        lead_({.joint = settings.joint,
               .inertia_kg_m2 = settings.inertia_kg_m2,
               .effort_max_Nm = settings.effort_max_Nm,
               .way_rad = 0,
               .stays_s = 3}),
        filter_({.cutoff_Hz = settings.velocity_cutoff_Hz, .dt_s = settings.period_s}) {}

  void begin(const BenchSight& sight) override {
    filter_.reset();
    start_rad_ = sight.position_rad[settings_.joint];
    lead_.begin(sight);
    carried_Nm_ = effort_Nm_ = overshoot_rad_ = reached_rad_ = 0;
    phase_ = turns_ = 0;
    stopped_.clear();
  }
  double step(const BenchSight& sight) override {
    const Settings& s = settings_;
    const double at_rad = sight.position_rad[s.joint];
    if (sight.since_s[s.joint] > 0) velocity_rad_s_ = filter_.update(at_rad, sight.since_s[s.joint]);
    if (phase_ == 0) {
      effort_Nm_ = lead_.step(sight);
      carried_Nm_ += (effort_Nm_ - carried_Nm_) * std::min(1.0, sight.dt_s / 0.3);
      if (lead_.complete()) next_phase(sight);
      return effort_Nm_;
    }
    if (!complete() && sight.time_s - begun_s_ >= phase_s) next_phase(sight);
    const double forth = phase_ == 2 ? s.step_rad : 0;
    const double written_Nm = effort_Nm_;
    effort_Nm_ = std::clamp(
        carried_Nm_ + s.stiffness_Nm_per_rad * (start_rad_ + forth - at_rad) - s.damping_Nms_per_rad * velocity_rad_s_,
        -s.effort_max_Nm, s.effort_max_Nm);
    look(at_rad - start_rad_);
    return aborted().empty() ? written_Nm : 0;
  }
  bool complete() const override { return phase_ >= 4; }
  std::string_view aborted() const override { return stopped_; }
  double overshoot() const noexcept { return std::max(0.0, overshoot_rad_) / settings_.step_rad; }  // share of the step
  double reached() const noexcept { return reached_rad_ / settings_.step_rad; }                     // at its end

 private:
  static constexpr double phase_s = 1.2;  // of: it stands; steps; steps back
  static constexpr int turns_max = 8;     // a good answer has two or three

  void next_phase(const BenchSight& sight) {
    ++phase_;
    begun_s_ = sight.time_s;
    turns_ = 0;
    turned_Nm_ = effort_Nm_;
  }
  void look(double way_rad) {
    const double step_rad = settings_.step_rad;
    // A turn: the effort went by half of the greatest one.
    if (turned_up_ ? effort_Nm_ > turned_Nm_ : effort_Nm_ < turned_Nm_) {
      turned_Nm_ = effort_Nm_;
    } else if (std::abs(effort_Nm_ - turned_Nm_) > 0.5 * settings_.effort_max_Nm) {
      turned_up_ = !turned_up_;
      turned_Nm_ = effort_Nm_;
      ++turns_;
    }
    if (phase_ == 2) {
      overshoot_rad_ = std::max(overshoot_rad_, way_rad - step_rad);
      reached_rad_ = way_rad;
    }
    if (turns_ > turns_max)
      stopped_ = "it oscillates: its effort went up and down " + std::to_string(turns_) + " times";
    if (way_rad > 1.7 * step_rad || way_rad < -0.7 * step_rad) stopped_ = "it goes too far beyond its step";
  }

  Settings settings_;
  Lead lead_;
  VelocityFilter filter_;
  double start_rad_ = 0, begun_s_ = 0, velocity_rad_s_ = 0, carried_Nm_ = 0, effort_Nm_ = 0, turned_Nm_ = 0,
         overshoot_rad_ = 0, reached_rad_ = 0;
  int phase_ = 0, turns_ = 0;
  bool turned_up_ = true;
  std::string stopped_;
};

}  // namespace kadans
