#include "cubic_spline.h"

#include <algorithm>
#include <cmath>

namespace kadans {

void CubicSpline::begin(double value, double velocity) noexcept {
  knots_[0] = {value, velocity, 0};
  count_ = 0;
  duration_s_ = 0;
}

bool CubicSpline::add(double value, double duration_s) noexcept {
  if (count_ == points_max || !(duration_s > 0)) return false;
  knots_[++count_] = {value, 0, duration_s};
  duration_s_ += duration_s;
  return true;
}

// A tridiagonal system for the velocities between the ends, solved by elimination (Thomas).
void CubicSpline::plan() noexcept {
  std::array<double, points_max + 1> upper{};
  for (std::size_t i = 1; i < count_; ++i) {
    const double before = 1 / knots_[i].duration_s, after = 1 / knots_[i + 1].duration_s;
    const double slopes = 3 * ((knots_[i].value - knots_[i - 1].value) * before * before +
                               (knots_[i + 1].value - knots_[i].value) * after * after);
    const double pivot = 2 * (before + after) - before * upper[i - 1];
    upper[i] = after / pivot;
    knots_[i].velocity = (slopes - before * knots_[i - 1].velocity) / pivot;
  }
  for (std::size_t i = count_; i-- > 1;) knots_[i].velocity -= upper[i] * knots_[i + 1].velocity;
}

SetpointState CubicSpline::inside(std::size_t segment, double time_s) const noexcept {
  const Knot& from = knots_[segment];
  const Knot& to = knots_[segment + 1];
  const double T = to.duration_s, t = time_s / T, way = to.value - from.value;
  const double c1 = from.velocity * T, c2 = 3 * way - (2 * from.velocity + to.velocity) * T;
  const double c3 = (from.velocity + to.velocity) * T - 2 * way;
  return {from.value + t * (c1 + t * (c2 + t * c3)), (c1 + t * (2 * c2 + t * 3 * c3)) / T,
          (2 * c2 + 6 * c3 * t) / T / T};
}

SetpointState CubicSpline::at(double time_s) const noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (time_s < knots_[i + 1].duration_s) return inside(i, time_s);
    time_s -= knots_[i + 1].duration_s;
  }
  return {knots_[count_].value, 0, 0};
}

// At the points, and where the velocity is 0 between them.
CubicSpline::Range CubicSpline::range() const noexcept {
  Range range{knots_[0].value, knots_[0].value};
  const auto include = [&](double value) { range = {std::min(range.lowest, value), std::max(range.highest, value)}; };
  for (std::size_t i = 0; i < count_; ++i) {
    include(knots_[i + 1].value);
    const double T = knots_[i + 1].duration_s;
    const double start = knots_[i].velocity, end = knots_[i + 1].velocity;
    const double mean = (knots_[i + 1].value - knots_[i].value) / T;
    const double a = 3 * (start + end - 2 * mean), b = 2 * (3 * mean - 2 * start - end), c = start;
    const double root = std::sqrt(std::max(0.0, b * b - 4 * a * c));
    const double q = -0.5 * (b + (b < 0 ? -root : root));  // no cancellation
    for (const double t : {q / a, c / q}) {
      if (t > 0 && t < 1) include(inside(i, t * T).value);
    }
  }
  return range;
}

}  // namespace kadans
