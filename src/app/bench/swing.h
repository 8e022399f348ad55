// Swings a joint about where it stands, by a sine of effort whose frequency rises to twice the first one, and finds
// from what its encoder told what the joint is:
//
//   effort(t - delay) = inertia a + viscous w + coulomb sign(w) + stiffness q + constant
//
// All of it is sent through one low pass, which also gives the derivatives (state variable filters: Young 1981,
// Automatica 17(1)); what remains is linear in the five, by least squares, for each delay. The delay with the least
// residual is taken. It is that from the tick in which an effort is asked for to the one in which the answer is read,
// with the half tick for which an effort stands on the mean.
#pragma once

#include <vector>

#include "lead.h"

namespace kadans {

struct JointFit {
  double inertia_kg_m2 = 0, viscous_Nms_per_rad = 0, coulomb_Nm = 0, stiffness_Nm_per_rad = 0;
  double delay_s = 0;
  double residual = 1;  // share of the effort that is not explained
};

struct SwingRecord {
  double dt_s = 1e-3;                           // of a tick, the mean
  std::vector<double> effort_Nm, position_rad;  // one a tick
};
// The middle of the swing is `middle_rad_s`. A record that is too short gives a residual of 1.
JointFit fit_joint(const SwingRecord& record, double middle_rad_s);

class Swing final : public Push {
 public:
  struct Settings {
    std::size_t joint = 0;
    double inertia_kg_m2 = 1, effort_max_Nm = 0;  // inertia: the model's
    double reach_rad = 0.02;                      // to either side
  };
  explicit Swing(const Settings& settings);

  void begin(const BenchSight& sight) override;
  double step(const BenchSight& sight) override;
  bool complete() const override { return phase_ == Phase::done; }
  bool moved() const noexcept { return moved_; }  // as far as can be measured
  JointFit fit() const { return fit_joint(record_, 1.5 * first_rad_s_); }

 private:
  enum class Phase : std::uint8_t { carry, grow, sweep, done };
  static constexpr double sweep_s = 6, seen_share = 0.3;

  void end_turn();

  Settings settings_;
  double first_rad_s_;  // of the swing
  double effort_Nm_ = 0;
  Phase phase_ = Phase::carry;
  bool moved_ = false;
  Lead lead_;
  double angle_rad_ = 0, least_rad_ = 0, most_rad_ = 0, swept_from_s_ = 0;
  SwingRecord record_;
};

}  // namespace kadans
