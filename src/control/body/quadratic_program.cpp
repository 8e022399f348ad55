#include "quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Jacobi>

namespace kadans {
namespace {

using Eigen::Index;

constexpr double feasible = 1e-9;    // of a row, for a normal of length 1 and bounds about 1
constexpr double dependent = 1e-16;  // squared share of a normal that is left beside the active ones

}  // namespace

QuadraticProgram::QuadraticProgram(Index variables_max, Index rows_max) {
  const Index n = variables_max, m = rows_max;
  for (Eigen::MatrixXd* square : {&hessian_, &free_hessian_, &factor_, &j_, &r_}) square->resize(n, n);
  for (Eigen::MatrixXd* columns : {&normals_, &equal_}) columns->resize(n, m);
  for (Eigen::VectorXd* each : {&gradient_, &diagonal_, &share_, &x_, &normal_, &d_, &z_, &step_}) each->resize(n);
  for (Eigen::VectorXd* each : {&lower_, &upper_, &own_, &multiplier_, &scale_}) each->resize(m);
  for (Eigen::VectorXd* each : {&active_multiplier_, &active_sign_}) each->resize(n + 1);
  active_.resize(n + 1), equal_row_.resize(m);
  side_.resize(m), skipped_.resize(m);
}

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
  for (Index i = 0; i < m_; ++i)
    if (!(lower_[i] <= upper_[i] && lower_[i] < unbounded && upper_[i] > -unbounded)) return false;
  return sum == 0;
}

// Of the normals that are left, the one that is most its own comes next. What each has of its own goes down with each
// reflection, and is computed anew where little is left of it (LAPACK's dgeqp3).
void QuadraticProgram::reflect() noexcept {
  equalities_ = rank_ = 0;
  for (Index row = 0; row < m_; ++row) {
    if (!is_equality(row)) continue;
    equal_.col(equalities_).head(n_) = normals_.col(row).head(n_);
    own_[equalities_] = scale_[row] * scale_[row];
    equal_row_[equalities_++] = row;
  }
  for (; rank_ < std::min(equalities_, n_); ++rank_) {
    const Index k = rank_, left = n_ - k;
    Index best = -1;
    double most = dependent;
    for (Index c = k; c < equalities_; ++c) {
      const double length = scale_[equal_row_[c]], length2 = length * length;
      if (!(own_[c] > 1e-3 * length2)) own_[c] = equal_.col(c).segment(k, left).squaredNorm();
      if (!(own_[c] > most * length2)) continue;
      most = own_[c] / length2;
      best = c;
    }
    if (best < 0) return;
    equal_.col(k).head(n_).swap(equal_.col(best).head(n_));
    std::swap(equal_row_[k], equal_row_[best]);
    std::swap(own_[k], own_[best]);
    auto v = equal_.col(k).segment(k, left);
    const double length = v.norm();
    diagonal_[k] = v[0] > 0 ? -length : length;
    v[0] -= diagonal_[k];
    share_[k] = 2 / v.squaredNorm();
    for (Index c = k + 1; c < equalities_; ++c) {
      auto other = equal_.col(c).segment(k, left);
      other -= share_[k] * v.dot(other) * v;
      own_[c] -= other[0] * other[0];
    }
  }
}

template <typename Vector>
void QuadraticProgram::turn_back(Vector&& v) const noexcept {
  for (Index k = rank_; k-- > 0;) {
    const auto reflection = equal_.col(k).segment(k, n_ - k);
    v.segment(k, n_ - k) -= share_[k] * reflection.dot(v.segment(k, n_ - k)) * reflection;
  }
}

// The minimum of what the equalities leave free. False: Z' H Z is not positive definite.
bool QuadraticProgram::start() noexcept {
  free_ = n_ - rank_;
  for (Index k = 0; k < rank_; ++k) {  // R' y = b
    double sum = lower_[equal_row_[k]];
    for (Index i = 0; i < k; ++i) sum -= equal_(i, k) * x_[i];
    x_[k] = sum / diagonal_[k];
  }
  turn_back(x_.head(n_));
  auto z = j_.topLeftCorner(n_, free_);
  z.setZero();
  for (Index k = 0; k < free_; ++k) {
    z(rank_ + k, k) = 1;
    turn_back(z.col(k));
  }
  const auto h = hessian_.topLeftCorner(n_, n_);
  if (rank_ == 0) {
    free_hessian_.topLeftCorner(n_, n_) = h;
  } else {
    for (Index k = 0; k < free_; ++k) {
      z_.head(n_).noalias() = h * z.col(k);
      free_hessian_.col(k).segment(k, free_ - k).noalias() = z.rightCols(free_ - k).transpose() * z_.head(n_);
    }
  }
  if (!factorise()) return false;
  normal_.head(n_) = gradient_.head(n_);
  if (rank_ > 0) normal_.head(n_).noalias() += h * x_.head(n_);
  d_.head(free_).noalias() = z.transpose() * normal_.head(n_);
  x_.head(n_).noalias() -= z * d_.head(free_);
  return true;
}

// L, and J = Z L^-T in the place of Z.
bool QuadraticProgram::factorise() noexcept {
  auto l = factor_.topLeftCorner(free_, free_);
  auto j = j_.topLeftCorner(n_, free_);
  steepest_ = 0;
  for (Index k = 0; k < free_; ++k) {
    const Index left = free_ - k;
    l.col(k).tail(left) = free_hessian_.col(k).segment(k, left);
    for (Index i = 0; i < k; ++i) l.col(k).tail(left) -= l(k, i) * l.col(i).tail(left);
    if (!(l(k, k) > 0)) return false;
    l.col(k).tail(left) /= std::sqrt(l(k, k));
    for (Index i = 0; i < k; ++i) j.col(k) -= l(k, i) * j.col(i);
    j.col(k) /= l(k, k);
    steepest_ = std::max(steepest_, j.col(k).squaredNorm());
  }
  return true;
}

QuadraticProgram::Candidate QuadraticProgram::most_violated() const noexcept {
  Candidate worst;
  double most = 1;
  for (Index row = 0; row < m_; ++row) {
    if (side_[row] != Side::none || skipped_[row]) continue;
    const double value = normals_.col(row).head(n_).dot(x_.head(n_));
    const double below = lower_[row] - value, above = value - upper_[row];
    const bool low = below > above;
    const double by = (low ? below : above) / (feasible * (scale_[row] + std::abs(low ? lower_[row] : upper_[row])));
    if (!(by > most)) continue;
    most = by;
    worst = {row, low ? 1.0 : -1.0};
  }
  return worst;
}

// z: the way in x. step_: how the active rows' multipliers go down on it.
void QuadraticProgram::directions() noexcept {
  const auto j = j_.topLeftCorner(n_, free_);
  d_.head(free_).noalias() = j.transpose() * normal_.head(n_);
  z_.head(n_).noalias() = j.rightCols(free_ - count_) * d_.segment(count_, free_ - count_);
  for (Index i = count_; i-- > 0;) {
    double sum = d_[i];
    for (Index k = i + 1; k < count_; ++k) sum -= r_(i, k) * step_[k];
    step_[i] = sum / r_(i, i);
  }
}

// What a row that depends on others may miss.
double QuadraticProgram::slack(Index row, double bound) const noexcept {
  return 1e3 * feasible * (scale_[row] + std::abs(bound)) * (1 + x_.head(n_).norm());
}

// How far the way goes until the multiplier of an active inequality is 0.
double QuadraticProgram::blocking(Index& position) const noexcept {
  double shortest = unbounded;
  for (Index i = 0; i < count_; ++i) {
    if (!(step_[i] > 0)) continue;
    const double length = active_multiplier_[i] / step_[i];
    if (!(length < shortest)) continue;
    shortest = length;
    position = i;
  }
  return shortest;
}

bool QuadraticProgram::take_in(const Candidate& candidate, double multiplier) noexcept {
  if (count_ == free_) return false;
  Eigen::JacobiRotation<double> turn;
  for (Index i = free_ - 1; i > count_; --i) {
    turn.makeGivens(d_[i - 1], d_[i], &d_[i - 1]);
    d_[i] = 0;
    j_.topLeftCorner(n_, free_).applyOnTheRight(i - 1, i, turn);
  }
  r_.col(count_).head(count_ + 1) = d_.head(count_ + 1);
  active_[count_] = candidate.row;
  active_sign_[count_] = candidate.sign;
  active_multiplier_[count_++] = multiplier;
  side_[candidate.row] = candidate.sign > 0 ? Side::lower : Side::upper;
  return true;
}

void QuadraticProgram::let_go(Index position) noexcept {
  side_[active_[position]] = Side::none;
  // What follows from the others may not follow from the rest.
  for (Index row = 0; row < m_; ++row) skipped_[row] = is_equality(row);
  --count_;
  for (Index k = position; k < count_; ++k) {
    r_.col(k).head(k + 2) = r_.col(k + 1).head(k + 2);
    active_[k] = active_[k + 1];
    active_sign_[k] = active_sign_[k + 1];
    active_multiplier_[k] = active_multiplier_[k + 1];
  }
  Eigen::JacobiRotation<double> turn;
  for (Index k = position; k < count_; ++k) {
    turn.makeGivens(r_(k, k), r_(k + 1, k));
    r_.block(0, k, free_, count_ - k).applyOnTheLeft(k, k + 1, turn.adjoint());
    j_.topLeftCorner(n_, free_).applyOnTheRight(k, k + 1, turn);
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
    const double free2 = d_.segment(count_, free_ - count_).squaredNorm();
    const double length2 = scale_[candidate.row] * scale_[candidate.row];
    const bool moves =
        count_ < free_ && free2 > dependent * std::max(d_.head(free_).squaredNorm(), length2 * steepest_);
    const double missing = bound - normal_.head(n_).dot(x_.head(n_));
    Index position = -1;
    const double in_dual = blocking(position), full = moves ? std::max(0.0, missing / free2) : unbounded;
    const double length = std::min(in_dual, full);
    if (!moves && missing <= slack(candidate.row, bound)) {
      skipped_[candidate.row] = true;
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

// Those of the equalities make up what is left of H x + g.
void QuadraticProgram::find_multipliers() noexcept {
  multiplier_.head(m_).setZero();
  normal_.head(n_).noalias() = hessian_.topLeftCorner(n_, n_) * x_.head(n_);
  normal_.head(n_) += gradient_.head(n_);
  for (Index i = 0; i < count_; ++i) {
    multiplier_[active_[i]] = active_sign_[i] * active_multiplier_[i];
    normal_.head(n_) -= multiplier_[active_[i]] * normals_.col(active_[i]).head(n_);
  }
  for (Index k = 0; k < rank_; ++k) {
    const auto reflection = equal_.col(k).segment(k, n_ - k);
    normal_.segment(k, n_ - k) -= share_[k] * reflection.dot(normal_.segment(k, n_ - k)) * reflection;
  }
  for (Index k = rank_; k-- > 0;) {
    double sum = normal_[k];
    for (Index i = k + 1; i < rank_; ++i) sum -= equal_(k, i) * multiplier_[equal_row_[i]];
    multiplier_[equal_row_[k]] = sum / diagonal_[k];
  }
}

// Whether the equalities that depend on others agree with them.
bool QuadraticProgram::agrees() const noexcept {
  for (Index k = rank_; k < equalities_; ++k) {
    const Index row = equal_row_[k];
    const double missing = std::abs(normals_.col(row).head(n_).dot(x_.head(n_)) - lower_[row]);
    if (!(missing <= slack(row, lower_[row]))) return false;
  }
  return true;
}

QuadraticProgram::Status QuadraticProgram::solve(int iterations_max) noexcept {
  count_ = rank_ = 0;
  iterations_ = 0;
  x_.head(n_).setZero();
  if (!finite()) return Status::refused;
  for (Index row = 0; row < m_; ++row) scale_[row] = normals_.col(row).head(n_).norm();
  reflect();
  if (!start()) return x_.head(n_).setZero(), Status::refused;
  for (Index row = 0; row < m_; ++row) side_[row] = Side::none, skipped_[row] = is_equality(row);
  Status status = agrees() ? Status::solved : Status::infeasible;
  for (Candidate worst = most_violated(); worst.row >= 0 && status == Status::solved; worst = most_violated())
    status = bring_in(worst, iterations_max);
  return 0 * x_.head(n_).sum() == 0 ? status : Status::refused;
}

}  // namespace kadans
