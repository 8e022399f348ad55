// The angle of a point by plain arithmetic, the same bits with every compiler and on every processor: the atan2 that
// the program defines (portable_math.cpp). The estimator needs four per tick.
//
// The smaller of the two coordinates over the larger is the tangent of at most 45 degrees. One of the four angles whose
// tangents are 0, 1/4, 1/2 and 1 is subtracted, the one that leaves at most 9.4 degrees, by tan(a - b) = (n - t d) / (d
// + t n). The numerator is exact, because t d is a power of two times d and between half of n and twice n. The errors
// of denominator and quotient are computed (T. Dekker, A floating-point technique for extending the available
// precision, 1971). The rest is the series q - q^3 / 3 + ... to the 19th power. The parts are added up, each in two
// numbers.
//
// Error below 0.6 units in the last place.
#pragma once

#include <algorithm>
#include <cmath>

namespace kadans {

namespace arc_tangent_parts {

// A number, and what it lacks in its last place.
struct Sum {
  double high, low;
};

struct Arc {
  double tangent;
  Sum angle_rad;
};

inline constexpr Arc arcs[]{{0, {0, 0}},
                            {0.25, {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57}},
                            {0.5, {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56}},
                            {1, {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
inline constexpr Sum quarter_rad{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
inline constexpr Sum half_rad{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

// The first 26 bits.
inline double head(double x) noexcept {
  const double spread = 0x1.000002p+27 * x;
  return spread - (spread - x);
}

inline Sum quotient(double numerator, const Sum& denominator) noexcept {
  const double d = denominator.high, inverse = 1 / d, q = numerator * inverse;
  const double q_head = head(q), d_head = head(d), q_tail = q - q_head, d_tail = d - d_head;
  const double product = q * d;
  const double missing = ((q_head * d_head - product) + q_head * d_tail + q_tail * d_head) + q_tail * d_tail;
  return {q, (((numerator - product) - missing) - q * denominator.low) * inverse};
}

// Of a quotient of at most 0.166, less the quotient itself.
inline double series(double q) noexcept {
  const double x = q * q, x2 = x * x, x4 = x2 * x2;
  const double first = (-1.0 / 3 + x / 5) + x2 * (-1.0 / 7 + x / 9);
  const double second = (-1.0 / 11 + x / 13) + x2 * (-1.0 / 15 + x / 17);
  return q * x * (first + x4 * (second + x4 * (-1.0 / 19)));
}

// a + sign b; a is the larger one.
inline Sum add(const Sum& a, double sign, const Sum& b) noexcept {
  const double b_high = sign * b.high, high = a.high + b_high;
  return {high, ((a.high - high) + b_high) + (a.low + sign * b.low)};
}

// Of a tangent of at most 1.
inline Sum angle_rad(double numerator, double denominator) noexcept {
  const Arc& arc =
      arcs[(numerator >= 0.125 * denominator) + (numerator > 0.366 * denominator) + (numerator > 0.716 * denominator)];
  const double more = arc.tangent * numerator, sum = denominator + more;
  const Sum q = quotient(numerator - arc.tangent * denominator, {sum, (denominator - sum) + more});
  return add(arc.angle_rad, 1, {q.high, q.low + series(q.high)});
}

}  // namespace arc_tangent_parts

// In (-pi, pi), of coordinates whose sizes lie between 2^-300 and 2^300.
inline double arc_tangent(double y, double x) noexcept {
  using namespace arc_tangent_parts;
  const double across = std::fabs(y), along = std::fabs(x);
  Sum angle = angle_rad(std::min(across, along), std::max(across, along));
  if (across > along) {
    angle = add(quarter_rad, x < 0 ? 1 : -1, angle);
  } else if (x < 0) {
    angle = add(half_rad, -1, angle);
  }
  return std::copysign(angle.high + angle.low, y);
}

}  // namespace kadans
