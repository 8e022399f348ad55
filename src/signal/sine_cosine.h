// Sine and cosine of one angle by plain arithmetic, the same bits with every compiler and on every processor. The sin,
// cos and sincos that the program defines (src/signal/portable_math.cpp) are this function. Code that needs it for a
// dozen joints per tick includes it here, so that it is inlined.
//
// The angle is taken modulo a quarter turn, which leaves at most 45 degrees. A quarter turn is the sum of three
// numbers. The first two have at most 33 bits, so their multiples are exact, and the rest of the angle is known as the
// sum of two numbers (W. Cody and W. Waite, Software Manual for the Elementary Functions, 1980). This also holds for
// the angle that comes nearest to a multiple: it misses 29 quarter turns by 6e-19 rad. For the rest the Taylor series
// to the 17th power is exact to double precision. Its terms are summed in pairs, which makes the chains of dependent
// operations short; the second number comes in by the first derivative.
//
// Error below 0.8 units in the last place. Angles of more than ten thousand radians, and values that are not finite, go
// to a slower function.
#pragma once

#include <cmath>
#include <numbers>

namespace kadans {

struct SineCosine {
  double sine, cosine;
};

// For any number, to one unit in the last place; NaN for values that are not finite.
SineCosine sine_cosine_anywhere(double angle_rad) noexcept;

namespace sine_cosine_series {

// For high + low, with |high| at most an eighth of a turn and |low| within its last place.
[[gnu::always_inline]] inline SineCosine near_zero(double high, double low) noexcept {
  constexpr double s3 = -1.0 / 6, s5 = 1.0 / 120, s7 = -1.0 / 5040, s9 = 1.0 / 362880, s11 = -1.0 / 39916800,
                   s13 = 1.0 / 6227020800, s15 = -1.0 / 1307674368000, s17 = 1.0 / 355687428096000;
  constexpr double c4 = 1.0 / 24, c6 = -1.0 / 720, c8 = 1.0 / 40320, c10 = -1.0 / 3628800, c12 = 1.0 / 479001600,
                   c14 = -1.0 / 87178291200, c16 = 1.0 / 20922789888000;
  const double x2 = high * high, x4 = x2 * x2, x8 = x4 * x4, half = 0.5 * x2, one = 1 - half;
  const double s = (s3 + s5 * x2) + x4 * (s7 + s9 * x2) + x8 * ((s11 + s13 * x2) + x4 * (s15 + s17 * x2));
  const double c = (c4 + c6 * x2) + x4 * (c8 + c10 * x2) + x8 * ((c12 + c14 * x2) + x4 * c16);
  return {high + (high * x2 * s + low * one), one + (((1 - one) - half) + (x4 * c - high * low))};
}

}  // namespace sine_cosine_series

[[gnu::always_inline]] inline SineCosine sine_cosine(double angle_rad) noexcept {
  if (!(std::fabs(angle_rad) < 1e4)) return sine_cosine_anywhere(angle_rad);
  const double scaled = angle_rad * (2 / std::numbers::pi);
  const int quarters = static_cast<int>(scaled + (scaled < 0 ? -0.5 : 0.5));
  if (quarters == 0) {
    const SineCosine near = sine_cosine_series::near_zero(angle_rad, 0);
    return {std::copysign(near.sine, angle_rad), near.cosine};  // of -0.0 it is -0.0
  }
  constexpr double quarter_rad = 0x1.921fb544p+0, rest_rad = 0x1.0b4611a6p-34, rest_of_rest_rad = 0x1.3198a2e037073p-69;
  const double first = angle_rad - quarters * quarter_rad, second = quarters * rest_rad;  // both exact
  const double high = first - second;
  const double low = ((first - high) - second) - quarters * rest_of_rest_rad;
  const auto [s, c] = sine_cosine_series::near_zero(high, low);
  switch (quarters & 3) {
    case 0:
      return {s, c};
    case 1:
      return {c, -s};
    case 2:
      return {-s, -c};
    default:
      return {-c, s};
  }
}

}  // namespace kadans
