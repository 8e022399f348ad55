#include "quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>

namespace kadans {
namespace {

using Eigen::Index;

constexpr double feasible = 1e-9;    // of a row, for a normal of length 1 and bounds about 1
constexpr double dependent = 1e-16;  // squared share of a normal that is left beside the active ones

}  // namespace

QuadraticProgram::QuadraticProgram(Index variables_max, Index rows_max)
    : hessian_(variables_max, variables_max),
      normals_(variables_max, rows_max),
      gradient_(variables_max),
      lower_(rows_max),
      upper_(rows_max),
      factor_(variables_max, variables_max),
      j_(variables_max, variables_max),
      r_(variables_max, variables_max),
      x_(variables_max),
      multiplier_(rows_max),
      scale_(rows_max),
      normal_(variables_max),
      d_(variables_max),
      z_(variables_max),
      step_(variables_max),
      active_multiplier_(variables_max + 1),
      active_(static_cast<std::size_t>(variables_max) + 1),
      active_sign_(static_cast<std::size_t>(variables_max) + 1),
      side_(static_cast<std::size_t>(rows_max)),
      skipped_(static_cast<std::size_t>(rows_max)) {}

void QuadraticProgram::begin(Index variables) noexcept {
  n_ = variables;
  m_ = count_ = 0;
  hessian().setZero();
  gradient().setZero();
}

// 0 * NaN and 0 * unbounded are NaN.
bool QuadraticProgram::finite() const noexcept {
  const double sum = 0 * hessian_.topLeftCorner(n_, n_).sum() + 0 * gradient_.head(n_).sum() +
                     0 * normals_.topLeftCorner(n_, m_).sum();
  bool fine = sum == 0;
  for (Index i = 0; i < m_; ++i)
    fine = fine && lower_[i] <= upper_[i] && lower_[i] < unbounded && upper_[i] > -unbounded;
  return fine;
}

// L, and J = L^-T.
bool QuadraticProgram::factorise() noexcept {
  auto l = factor_.topLeftCorner(n_, n_);
  for (Index k = 0; k < n_; ++k) {
    for (Index i = k; i < n_; ++i) l(i, k) = hessian_(i, k) - l.row(i).head(k).dot(l.row(k).head(k));
    if (!(l(k, k) > 0)) return false;
    l(k, k) = std::sqrt(l(k, k));
    l.col(k).tail(n_ - k - 1) /= l(k, k);
  }
  auto j = j_.topLeftCorner(n_, n_);
  j.setZero();
  for (Index k = 0; k < n_; ++k) {  // the columns of L^-1 become the rows of J
    j(k, k) = 1 / l(k, k);
    for (Index i = k + 1; i < n_; ++i) j(k, i) = -l.row(i).segment(k, i - k).dot(j.row(k).segment(k, i - k)) / l(i, i);
  }
  return true;
}

QuadraticProgram::Candidate QuadraticProgram::most_violated() const noexcept {
  Candidate worst;
  double most = 1;
  bool equality = false;
  for (Index row = 0; row < m_; ++row) {
    const auto at = static_cast<std::size_t>(row);
    if (side_[at] != Side::none || skipped_[at] || (equality && !is_equality(row))) continue;
    const double value = normals_.col(row).head(n_).dot(x_.head(n_));
    const double below = lower_[row] - value, above = value - upper_[row];
    const bool low = below > above;
    const double bound = low ? lower_[row] : upper_[row];
    const double by = (low ? below : above) / (feasible * (scale_[row] + std::abs(bound)));
    const bool first = is_equality(row) && !equality;  // equalities come first, even those that hold already
    if (!first && !(by > most)) continue;
    if (first) equality = true;
    most = by;
    worst = {row, low ? 1.0 : -1.0};
  }
  return worst;
}

// z: the way in x. step_: how the active rows' multipliers go down on it.
void QuadraticProgram::directions() noexcept {
  const auto j = j_.topLeftCorner(n_, n_);
  d_.head(n_).noalias() = j.transpose() * normal_.head(n_);
  z_.head(n_).noalias() = j.rightCols(n_ - count_) * d_.segment(count_, n_ - count_);
  for (Index i = count_; i-- > 0;) {
    double sum = d_[i];
    for (Index k = i + 1; k < count_; ++k) sum -= r_(i, k) * step_[k];
    step_[i] = sum / r_(i, i);
  }
}

// How far the way goes until the multiplier of an active inequality is 0.
double QuadraticProgram::blocking(Index& position) const noexcept {
  double shortest = unbounded;
  for (Index i = 0; i < count_; ++i) {
    if (is_equality(active_[static_cast<std::size_t>(i)]) || !(step_[i] > 0)) continue;
    const double length = active_multiplier_[i] / step_[i];
    if (!(length < shortest)) continue;
    shortest = length;
    position = i;
  }
  return shortest;
}

bool QuadraticProgram::take_in(const Candidate& candidate, double multiplier) noexcept {
  if (count_ == n_) return false;
  Eigen::JacobiRotation<double> turn;
  for (Index i = n_ - 1; i > count_; --i) {
    turn.makeGivens(d_[i - 1], d_[i], &d_[i - 1]);
    d_[i] = 0;
    j_.topLeftCorner(n_, n_).applyOnTheRight(i - 1, i, turn);
  }
  r_.col(count_).head(count_ + 1) = d_.head(count_ + 1);
  const auto at = static_cast<std::size_t>(count_);
  active_[at] = candidate.row;
  active_sign_[at] = candidate.sign;
  active_multiplier_[count_++] = multiplier;
  side_[static_cast<std::size_t>(candidate.row)] = candidate.sign > 0 ? Side::lower : Side::upper;
  return true;
}

void QuadraticProgram::let_go(Index position) noexcept {
  side_[static_cast<std::size_t>(active_[static_cast<std::size_t>(position)])] = Side::none;
  std::fill_n(skipped_.begin(), m_, false);  // what follows from the others may not follow from the rest
  --count_;
  for (Index k = position; k < count_; ++k) {
    r_.col(k).head(k + 2) = r_.col(k + 1).head(k + 2);
    active_[static_cast<std::size_t>(k)] = active_[static_cast<std::size_t>(k + 1)];
    active_sign_[static_cast<std::size_t>(k)] = active_sign_[static_cast<std::size_t>(k + 1)];
    active_multiplier_[k] = active_multiplier_[k + 1];
  }
  Eigen::JacobiRotation<double> turn;
  for (Index k = position; k < count_; ++k) {
    turn.makeGivens(r_(k, k), r_(k + 1, k));
    r_.block(0, k, n_, count_ - k).applyOnTheLeft(k, k + 1, turn.adjoint());
    j_.topLeftCorner(n_, n_).applyOnTheRight(k, k + 1, turn);
  }
}

// Goes until the row is active, or follows from others, or cannot be.
QuadraticProgram::Status QuadraticProgram::bring_in(Candidate candidate, int iterations_max) noexcept {
  normal_.head(n_) = candidate.sign * normals_.col(candidate.row).head(n_);
  double multiplier = 0;
  const double bound = candidate.sign > 0 ? lower_[candidate.row] : -upper_[candidate.row];
  for (;;) {
    if (iterations_++ == iterations_max) return Status::iterations_exhausted;
    directions();
    const double free2 = d_.segment(count_, n_ - count_).squaredNorm();
    const bool moves = count_ < n_ && free2 > dependent * d_.head(n_).squaredNorm();
    const double missing = bound - normal_.head(n_).dot(x_.head(n_));
    Index position = -1;
    const double in_dual = blocking(position), full = moves ? std::max(0.0, missing / free2) : unbounded;
    const double length = std::min(in_dual, full);
    if (!moves && missing <= 1e3 * feasible * (scale_[candidate.row] + std::abs(bound)) * (1 + x_.head(n_).norm())) {
      skipped_[static_cast<std::size_t>(candidate.row)] = true;
      return Status::solved;
    }
    if (length == unbounded) return Status::infeasible;
    active_multiplier_.head(count_) -= length * step_.head(count_);
    multiplier += length;
    if (moves) x_.head(n_) += length * z_.head(n_);
    if (length == full) return take_in(candidate, multiplier) ? Status::solved : Status::infeasible;
    let_go(position);
  }
}

void QuadraticProgram::store_multipliers() noexcept {
  multiplier_.head(m_).setZero();
  for (Index i = 0; i < count_; ++i) {
    const auto at = static_cast<std::size_t>(i);
    multiplier_[active_[at]] = active_sign_[at] * active_multiplier_[i];
  }
}

QuadraticProgram::Status QuadraticProgram::solve(int iterations_max) noexcept {
  count_ = 0;
  iterations_ = 0;
  x_.head(n_).setZero();
  multiplier_.head(m_).setZero();
  if (!finite() || !factorise()) return Status::refused;
  auto j = j_.topLeftCorner(n_, n_);
  d_.head(n_).noalias() = j.transpose() * gradient_.head(n_);
  x_.head(n_).noalias() = j * d_.head(n_);
  x_.head(n_) = -x_.head(n_);
  std::fill_n(side_.begin(), m_, Side::none);
  std::fill_n(skipped_.begin(), m_, false);
  for (Index row = 0; row < m_; ++row) scale_[row] = normals_.col(row).head(n_).norm();
  Status status = Status::solved;
  for (Candidate worst = most_violated(); worst.row >= 0 && status == Status::solved; worst = most_violated())
    status = bring_in(worst, iterations_max);
  store_multipliers();
  return 0 * x_.head(n_).sum() == 0 ? status : Status::refused;
}

}  // namespace kadans
