// A small dense quadratic program, strictly convex:
//
//   minimise 1/2 x' H x + g' x   subject to   lower_i <= a_i' x <= upper_i
//
// A row with lower == upper is an equality; an infinite bound is none. H is symmetric and positive definite: whoever
// states a problem regularises it, and says how.
//
// The equalities go first, all at once: Householder reflections of their normals (with pivoting) give a point that
// fulfils them and a basis Z of what they leave free (Nocedal and Wright 2006, Numerical Optimization, section 16.2).
// One that depends on others is left out when it agrees with them.
//
// In what is left the method is the dual active-set method of Goldfarb and Idnani (1983, Mathematical Programming 27).
// It begins at the minimum without inequalities and takes in the one that is violated most, until none is. Each
// iteration keeps the conditions of optimality, so that no feasible point is needed to begin with, and a problem
// without solution ends with the row that contradicts the active ones. The active rows' normals N are kept as
//
//   J' N = (R; 0),   J = Z L^-T Q,   Z' H Z = L L',
//
// with R upper triangular, updated by Givens rotations when a row comes or goes.
//
// At a solution (Nocedal and Wright 2006, section 16.1)
//
//   H x + g = sum y_i a_i,   y_i >= 0 at the lower bound, y_i <= 0 at the upper bound, else y_i = 0.
//
// One owner, any thread. Only the constructor allocates; solve() takes at most iterations_max iterations, each of
// O(n^2 + rows n) operations.
#pragma once

#include <cstdint>
#include <limits>

#include <Eigen/Core>

namespace kadans {

class QuadraticProgram {
 public:
  enum class Status : std::uint8_t {
    solved,
    infeasible,            // no point fulfils all constraints
    iterations_exhausted,  // x fulfils those that were taken in so far
    refused  // a number is not finite, of the problem or of x, a lower bound is above the upper one, or H is not
             // positive definite in what the equalities leave free
  };

  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  // Room for problems up to this size.
  QuadraticProgram(Eigen::Index variables_max, Eigen::Index rows_max);

  // Begins a problem: everything is 0, and there is no row. Sizes must be within the room.
  void begin(Eigen::Index variables) noexcept;
  Eigen::Index variables() const noexcept { return n_; }
  Eigen::Index rows() const noexcept { return m_; }
  // H and g, to be filled or added to.
  auto hessian() noexcept { return hessian_.topLeftCorner(n_, n_); }
  auto gradient() noexcept { return gradient_.head(n_); }
  // Adds `weight` (a' x - b)^2 / 2 to what is minimised; a(k) gives the first `size` components, the others are 0.
  template <typename Normal>
  void add_square(Eigen::Index size, const Normal& a, double b, double weight) noexcept {
    for (Eigen::Index k = 0; k < size; ++k) normal_[k] = a(k);
    for (Eigen::Index k = 0; k < size; ++k) {
      const double share = weight * normal_[k];
      if (share == 0) continue;
      gradient_[k] -= share * b;
      hessian_.col(k).head(size) += share * normal_.head(size);
    }
  }
  // Adds a row whose normal the caller fills. There must be room.
  auto add_row(double lower, double upper) noexcept {
    lower_[m_] = lower;
    upper_[m_] = upper;
    normals_.col(m_).head(n_).setZero();
    return normals_.col(m_++).head(n_);
  }

  [[nodiscard]] Status solve(int iterations_max) noexcept;

  auto solution() const noexcept { return x_.head(n_); }
  // y, one a row; computed here.
  auto multipliers() noexcept {
    find_multipliers();
    return multiplier_.head(m_);
  }
  int iterations() const noexcept { return iterations_; }  // of the last solve(), for inequalities

 private:
  using IndexVector = Eigen::Matrix<Eigen::Index, Eigen::Dynamic, 1>;
  enum class Side : std::int8_t { none = 0, lower = 1, upper = -1 };
  struct Candidate {
    Eigen::Index row = -1;
    double sign = 1;  // -1: at its upper bound
  };
  bool finite() const noexcept;
  void reflect() noexcept;
  template <typename Vector>
  void turn_back(Vector&& v) const noexcept;  // Q v, with Q of the reflections
  bool start() noexcept;
  bool factorise() noexcept;
  bool is_equality(Eigen::Index row) const noexcept { return lower_[row] == upper_[row]; }
  Candidate most_violated() const noexcept;
  void directions() noexcept;
  bool agrees() const noexcept;
  double slack(Eigen::Index row, double bound) const noexcept;
  double blocking(Eigen::Index& position) const noexcept;
  bool take_in(const Candidate& candidate, double multiplier) noexcept;
  void let_go(Eigen::Index position) noexcept;
  Status bring_in(Candidate candidate, int iterations_max) noexcept;
  void find_multipliers() noexcept;

  Eigen::MatrixXd hessian_, normals_;  // the rows' normals are columns
  Eigen::VectorXd gradient_, lower_, upper_;
  // Of the equalities: their normals, which become reflections below the diagonal and a triangle above it.
  Eigen::MatrixXd equal_;
  IndexVector equal_row_;
  Eigen::VectorXd own_;               // of each normal: what no other one has, squared
  Eigen::VectorXd diagonal_, share_;  // of the triangle; how much of a reflection's own vector it takes away
  Eigen::Index equalities_ = 0, rank_ = 0;
  Eigen::MatrixXd free_hessian_, factor_, j_, r_;
  double steepest_ = 0;                     // the longest column of J, squared
  Eigen::VectorXd x_, multiplier_, scale_;  // scale: the length of a row's normal
  Eigen::VectorXd normal_, d_, z_, step_;   // of the row that comes in
  Eigen::VectorXd active_multiplier_, active_sign_;
  IndexVector active_;
  Eigen::Matrix<Side, Eigen::Dynamic, 1> side_;
  Eigen::Matrix<bool, Eigen::Dynamic, 1> skipped_;     // rows that hold because the active ones do
  Eigen::Index n_ = 0, m_ = 0, free_ = 0, count_ = 0;  // free_: variables that the equalities leave
  int iterations_ = 0;
};

}  // namespace kadans
