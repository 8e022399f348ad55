// The solver against the conditions of optimality, on random problems: 2,000 of them, with KADANS_SOAK 100,000.
#include "control/body/quadratic_program.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"
#include "kadans/testing/allocation_count.h"

namespace quadratic_program_test {

using namespace kadans;
using Eigen::Index;
using Status = QuadraticProgram::Status;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Index variables_max = 14, rows_max = 40;

int problems() {
  return std::getenv("KADANS_SOAK") != nullptr ? 100'000 : 2'000;  // NOLINT(concurrency-mt-unsafe): one thread
}

// A problem as its own matrices, so that the checks do not read the solver's.
struct Problem {
  Eigen::MatrixXd hessian, normals;  // normals: a row each
  Eigen::VectorXd gradient, lower, upper;

  void state(QuadraticProgram& program) const {
    program.begin(gradient.size());
    program.hessian() = hessian;
    program.gradient() = gradient;
    for (Index i = 0; i < lower.size(); ++i) program.add_row(lower[i], upper[i]) = normals.row(i).transpose();
  }
};

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed, "quadratic_program_test") {}

  double between(double low, double high) { return random_.uniform(low, high); }
  Index index(Index low, Index high) {
    return low + static_cast<Index>(between(0, static_cast<double>(high - low + 1)));
  }
  bool chance(double share) { return random_.uniform() < share; }
  Eigen::VectorXd vector(Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [&](Index) { return between(-1, 1); });
  }

  // Feasible: all rows hold at a point that is drawn first. Many rows are equalities, bounds that meet at that point,
  // copies and sums of other rows.
  Problem problem() {
    Problem p;
    const Index n = index(1, variables_max), m = index(0, rows_max - 2);
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(n, n, [&](Index, Index) { return between(-1, 1); });
    p.hessian = root * root.transpose() + std::pow(10.0, between(-4, 1)) * Eigen::MatrixXd::Identity(n, n);
    p.gradient = between(0, 10) * vector(n);
    p.normals.resize(m, n);
    p.lower.resize(m);
    p.upper.resize(m);
    const Eigen::VectorXd inside = vector(n);
    Index equalities = 0;
    for (Index i = 0; i < m; ++i) {
      p.normals.row(i) = normal(p, n, i).transpose();
      const double value = p.normals.row(i).dot(inside);
      const bool equal = equalities <= n / 2 + 1 && chance(0.2);
      equalities += equal ? 1 : 0;
      const bool meets = chance(0.2);
      p.lower[i] = equal || meets ? value : chance(0.2) ? -infinity : value - between(0, 1);
      p.upper[i] = equal ? value : chance(0.2) ? infinity : value + between(0, 1);
    }
    return p;
  }

 private:
  Eigen::VectorXd normal(const Problem& p, Index n, Index i) {
    if (i > 0 && chance(0.1)) return p.normals.row(index(0, i - 1)).transpose();
    if (i > 1 && chance(0.1)) return (p.normals.row(i - 1) - 2 * p.normals.row(i - 2)).transpose();
    if (chance(0.3)) return Eigen::VectorXd::Unit(n, index(0, n - 1));
    return std::pow(10.0, between(-1, 1)) * vector(n);
  }

  RandomStream random_;
};

// By how much the point of the program misses the conditions of optimality, relative to the sizes of the numbers.
double misses(const Problem& p, QuadraticProgram& program) {
  const Eigen::VectorXd x = program.solution(), y = program.multipliers();
  const double size = 1 + p.gradient.norm() + x.norm() + y.cwiseAbs().sum();
  double worst = (p.hessian * x + p.gradient - p.normals.transpose() * y).norm();
  for (Index i = 0; i < y.size(); ++i) {
    const double value = p.normals.row(i).dot(x);
    worst = std::max({worst, p.lower[i] - value, value - p.upper[i]});
    if (p.lower[i] == p.upper[i]) continue;
    if (y[i] > 0) worst = std::max(worst, y[i] * std::abs(value - p.lower[i]));
    if (y[i] < 0) worst = std::max(worst, -y[i] * std::abs(p.upper[i] - value));
  }
  return worst / size;
}

}  // namespace

TEST_CASE("the solution of a random problem fulfils the conditions of optimality, degenerate and redundant rows too") {
  Draw draw(1);
  QuadraticProgram program(variables_max, rows_max);
  double worst = 0;
  int most = 0, failed = 0;
  for (int i = 0; i < problems(); ++i) {
    const Problem problem = draw.problem();
    problem.state(program);
    if (program.solve(500) != Status::solved) {
      ++failed;
      continue;
    }
    worst = std::max(worst, misses(problem, program));
    most = std::max(most, program.iterations());
  }
  CHECK(failed == 0);
  CHECK(worst < 1e-6);  // rows that nearly depend on each other; all but six of 100,000 are below 1e-9
  CHECK(most <= 120);
  MESSAGE("worst " << worst << ", at most " << most << " iterations");
}

TEST_CASE("a problem whose rows contradict each other is infeasible, by two rows or by a sum of several") {
  Draw draw(2);
  QuadraticProgram program(variables_max, rows_max);
  int found = 0, contradictions = 0;
  for (int i = 0; i < problems() / 4; ++i) {
    Problem problem = draw.problem();
    const Index m = problem.lower.size();
    if (m < 2) continue;
    // The weighted sum of two rows has a greatest value; one more row asks for more.
    const double first = draw.between(0.1, 1), second = draw.between(0.1, 1);
    if (!std::isfinite(problem.upper[0]) || !std::isfinite(problem.upper[1])) continue;
    const Eigen::RowVectorXd sum = first * problem.normals.row(0) + second * problem.normals.row(1);
    if (sum.norm() < 0.05) continue;
    problem.normals.conservativeResize(m + 1, Eigen::NoChange);
    problem.normals.row(m) = sum;
    problem.lower.conservativeResize(m + 1);
    problem.upper.conservativeResize(m + 1);
    problem.lower[m] = first * problem.upper[0] + second * problem.upper[1] + draw.between(0.01, 1);
    problem.upper[m] = infinity;
    ++contradictions;
    problem.state(program);
    found += program.solve(500) == Status::infeasible ? 1 : 0;
  }
  CHECK(contradictions > 100);
  CHECK(found == contradictions);
}

TEST_CASE("without rows the solution is the minimum, and a row that does not bind has no multiplier") {
  QuadraticProgram program(2, 2);
  program.begin(2);
  program.hessian() << 2, 0, 0, 4;
  program.gradient() << -2, -8;
  REQUIRE(program.solve(10) == Status::solved);
  CHECK(program.solution()[0] == doctest::Approx(1));
  CHECK(program.solution()[1] == doctest::Approx(2));
  program.add_row(-infinity, 5) << 1, 1;
  program.add_row(-infinity, 2) << 1, 1;
  REQUIRE(program.solve(10) == Status::solved);
  CHECK(program.solution().sum() == doctest::Approx(2));
  CHECK(program.multipliers()[0] == 0);
  CHECK(program.multipliers()[1] == doctest::Approx(-4.0 / 3));
}

TEST_CASE("a number that is not finite, bounds that cross and a Hessian that is not positive definite are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  QuadraticProgram program(2, 1);
  const auto solved_with = [&](double h, double g, double a, double lower, double upper) {
    program.begin(2);
    program.hessian() << h, 0, 0, 1;
    program.gradient() << g, 0;
    program.add_row(lower, upper) << a, 1;
    return program.solve(10);
  };
  CHECK(solved_with(1, 1, 1, 0, infinity) == Status::solved);
  CHECK(solved_with(nan, 1, 1, 0, 1) == Status::refused);
  CHECK(solved_with(1, nan, 1, 0, 1) == Status::refused);
  CHECK(solved_with(1, infinity, 1, 0, 1) == Status::refused);
  CHECK(solved_with(1, 1, nan, 0, 1) == Status::refused);
  CHECK(solved_with(1, 1, 1, nan, 1) == Status::refused);
  CHECK(solved_with(1, 1, 1, 0, nan) == Status::refused);
  CHECK(solved_with(1, 1, 1, infinity, infinity) == Status::refused);
  CHECK(solved_with(1, 1, 1, 1, 0) == Status::refused);
  CHECK(solved_with(0, 1, 1, 0, 1) == Status::refused);
  CHECK(solved_with(-1, 1, 1, 0, 1) == Status::refused);
  CHECK(program.solution().norm() == 0);
}

TEST_CASE("the iterations are bounded, and the solver says when they did not suffice") {
  Draw draw(3);
  QuadraticProgram program(variables_max, rows_max);
  int exhausted = 0;
  for (int i = 0; i < 200; ++i) {
    draw.problem().state(program);
    const Status status = program.solve(3);
    CHECK((status == Status::solved || status == Status::iterations_exhausted));
    exhausted += status == Status::iterations_exhausted ? 1 : 0;
    CHECK(program.iterations() <= 4);
  }
  CHECK(exhausted > 50);
}

TEST_CASE("solving allocates nothing") {
  Draw draw(4);
  QuadraticProgram program(variables_max, rows_max);
  for (int i = 0; i < 20; ++i) {
    const Problem problem = draw.problem();
    const kadans::testing::AllocationCount heap;
    problem.state(program);
    const Status status = program.solve(500);
    const long allocations = heap.count();
    CHECK(allocations == 0);
    CHECK(status == Status::solved);
  }
}

}  // namespace quadratic_program_test
