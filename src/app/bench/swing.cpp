#include "swing.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace kadans {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// A low pass of the second order, and its first two derivatives: two trapezoidal integrators. Behind another one, so
// that an encoder's steps do not reach the derivatives.
class LowPass {
 public:
  LowPass(double cutoff_rad_s, double dt_s) : band_per_s_(cutoff_rad_s), g_(std::tan(cutoff_rad_s * dt_s / 2)) {}

  struct Value {
    double value = 0, rate = 0, acceleration = 0;
  };
  Value step(double input) noexcept {
    const double a1 = 1 / (1 + g_ * (g_ + std::numbers::sqrt2));
    const double high = input - low_state_;
    const double band = a1 * (band_state_ + g_ * high), low = low_state_ + g_ * band;
    band_state_ = 2 * band - band_state_;
    low_state_ = 2 * low - low_state_;
    return {low, band_per_s_ * band, band_per_s_ * band_per_s_ * (input - std::numbers::sqrt2 * band - low)};
  }

 private:
  double band_per_s_, g_;
  double band_state_ = 0, low_state_ = 0;
};
struct Filtered {
  Filtered(double cutoff_rad_s, double dt_s) : first(cutoff_rad_s, dt_s), second(cutoff_rad_s, dt_s) {}
  LowPass::Value step(double input) noexcept { return second.step(first.step(input).value); }
  LowPass first, second;
};

}  // namespace

JointFit fit_joint(const SwingRecord& record, double middle_rad_s) {
  constexpr Eigen::Index unknowns = 5;
  constexpr double delay_max_s = 0.04, settles = 10;  // time constants of the low pass
  const std::size_t count = record.position_rad.size();
  const double dt_s = record.dt_s, cutoff_rad_s = std::min(3 * middle_rad_s, 0.5 / dt_s);
  const auto first = static_cast<std::size_t>((settles / cutoff_rad_s + delay_max_s) / dt_s) + 1;
  if (count < 4 * first) return {};
  // The sign of the velocity as it was then: by differences to either side.
  const auto near = static_cast<std::size_t>(std::max(1.0, std::round(0.3 / middle_rad_s / dt_s)));
  const double soft_rad_s = 0.05;
  const auto n = static_cast<Eigen::Index>(count);
  Eigen::MatrixXd parts(n, unknowns);
  Eigen::VectorXd effort(n);
  Filtered position(cutoff_rad_s, dt_s), push(cutoff_rad_s, dt_s), sign(cutoff_rad_s, dt_s);
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const std::size_t before = i < near ? 0 : i - near, after = std::min(i + near, count - 1);
    const double velocity_rad_s = (record.position_rad[after] - record.position_rad[before]) /
                                  (static_cast<double>(std::max<std::size_t>(1, after - before)) * dt_s);
    const LowPass::Value q = position.step(record.position_rad[i] - record.position_rad[0]);
    parts.row(k) << q.acceleration, q.rate, sign.step(std::tanh(velocity_rad_s / soft_rad_s)).value, q.value, 1;
    effort[k] = push.step(record.effort_Nm[i]).value;
  }
  const Eigen::Index from = static_cast<Eigen::Index>(first), rows = n - from;
  const Eigen::MatrixXd used = parts.bottomRows(rows);
  const Eigen::LDLT<Eigen::MatrixXd> normal((used.transpose() * used).eval());
  JointFit best;
  for (double delay_s = 0; delay_s < delay_max_s; delay_s += dt_s / 8) {
    const double ticks = delay_s / dt_s;
    const auto whole = static_cast<Eigen::Index>(ticks);
    const double part = ticks - static_cast<double>(whole);
    const Eigen::VectorXd delayed =
        (1 - part) * effort.segment(from - whole, rows) + part * effort.segment(from - whole - 1, rows);
    const Eigen::VectorXd is = normal.solve(used.transpose() * delayed);
    const double middle_Nm = delayed.mean();
    const double all = (delayed.array() - middle_Nm).matrix().norm();
    const double residual = all > 0 ? (used * is - delayed).norm() / all : 1;
    if (!(residual < best.residual)) continue;
    best = {.inertia_kg_m2 = is[0],
            .viscous_Nms_per_rad = is[1],
            .coulomb_Nm = is[2],
            .stiffness_Nm_per_rad = is[3],
            .delay_s = delay_s,
            .residual = residual};
  }
  return best;
}

// effort = inertia frequency^2 reach, where half of the greatest effort does it.
Swing::Swing(const Settings& settings)
    : settings_(settings),
      first_rad_s_(std::clamp(std::sqrt(settings.effort_max_Nm / (2 * settings.inertia_kg_m2 * settings.reach_rad)),
                              two_pi * 0.7, two_pi * 5)),
      lead_({.joint = settings.joint,
             .inertia_kg_m2 = settings.inertia_kg_m2,
             .effort_max_Nm = settings.effort_max_Nm,
             .way_rad = 0,
             .stays_s = 3}) {}

void Swing::begin(const BenchSight& sight) {
  phase_ = Phase::carry;
  lead_.begin(sight);
  angle_rad_ = 0;
  effort_Nm_ = std::min(settings_.effort_max_Nm,
                        settings_.inertia_kg_m2 * first_rad_s_ * first_rad_s_ * settings_.reach_rad / 2);
  moved_ = false;
  record_ = {};
}

// Grows until it swings as far as it shall.
void Swing::end_turn() {
  const double reach_rad = (most_rad_ - least_rad_) / 2;
  least_rad_ = 1e9;
  most_rad_ = -1e9;
  moved_ = reach_rad > seen_share * settings_.reach_rad;
  if (reach_rad > 0.8 * settings_.reach_rad || effort_Nm_ >= settings_.effort_max_Nm) {
    phase_ = moved_ ? Phase::sweep : Phase::done;
    return;
  }
  effort_Nm_ = std::min(1.3 * effort_Nm_, settings_.effort_max_Nm);
}

double Swing::step(const BenchSight& sight) {
  const double at_rad = sight.position_rad[settings_.joint];
  const double carried_Nm = lead_.step(sight);
  if (phase_ == Phase::carry && lead_.complete()) {
    phase_ = Phase::grow;
    least_rad_ = most_rad_ = at_rad;
  }
  if (phase_ == Phase::carry || phase_ == Phase::done) return carried_Nm;
  least_rad_ = std::min(least_rad_, at_rad);
  most_rad_ = std::max(most_rad_, at_rad);
  double faster = 1;
  if (phase_ == Phase::sweep) {
    const double swept_s = static_cast<double>(record_.effort_Nm.size()) * record_.dt_s;
    faster += std::min(1.0, swept_s / sweep_s);
    if (swept_s >= sweep_s) phase_ = Phase::done;
  }
  angle_rad_ += first_rad_s_ * faster * sight.dt_s;
  if (phase_ == Phase::grow && angle_rad_ >= two_pi) {
    angle_rad_ -= two_pi;
    end_turn();
  }
  // Faster, it takes more effort to swing far enough to be seen.
  const double effort_Nm = std::clamp(carried_Nm + effort_Nm_ * faster * std::cos(angle_rad_), -settings_.effort_max_Nm,
                                      settings_.effort_max_Nm);
  if (phase_ == Phase::sweep) {
    if (record_.effort_Nm.empty()) swept_from_s_ = sight.time_s - sight.dt_s;
    record_.effort_Nm.push_back(effort_Nm);
    record_.position_rad.push_back(at_rad);
    record_.dt_s = (sight.time_s - swept_from_s_) / static_cast<double>(record_.effort_Nm.size());
  }
  return effort_Nm;
}

}  // namespace kadans
