// Sine and cosine of a joint's angle, in half the time of the library's and by plain arithmetic, so that they are the
// same everywhere. The angle is taken modulo a quarter turn, which leaves at most 45 degrees; there the Taylor series
// to the 17th power is exact to double precision. Error below 3e-16 up to 1e4 rad; beyond, and for what is not finite,
// the library answers.
#pragma once

#include <cmath>
#include <numbers>

namespace kadans {

struct SineCosine {
  double sine, cosine;
};

[[gnu::always_inline]] inline SineCosine sine_cosine(double angle_rad) noexcept {
  if (!(std::fabs(angle_rad) < 1e4)) return {std::sin(angle_rad), std::cos(angle_rad)};
  // A quarter turn in two parts: the first has so few bits that its multiples are exact.
  constexpr double quarter_high_rad = 0x1.921fb544p+0, quarter_low_rad = 0x1.0b4611a626331p-34;
  const double scaled = angle_rad * (2 / std::numbers::pi);
  const int quarters = static_cast<int>(scaled + (scaled < 0 ? -0.5 : 0.5));
  const double x = (angle_rad - quarters * quarter_high_rad) - quarters * quarter_low_rad;
  const double x2 = x * x;
  constexpr double s3 = -1.0 / 6, s5 = 1.0 / 120, s7 = -1.0 / 5040, s9 = 1.0 / 362880, s11 = -1.0 / 39916800,
                   s13 = 1.0 / 6227020800, s15 = -1.0 / 1307674368000, s17 = 1.0 / 355687428096000;
  constexpr double c4 = 1.0 / 24, c6 = -1.0 / 720, c8 = 1.0 / 40320, c10 = -1.0 / 3628800, c12 = 1.0 / 479001600,
                   c14 = -1.0 / 87178291200, c16 = 1.0 / 20922789888000;
  const double x4 = x2 * x2, x8 = x4 * x4;  // summed in pairs: shorter chains of dependence
  const double s =
      x + x * x2 * ((s3 + s5 * x2) + x4 * (s7 + s9 * x2) + x8 * ((s11 + s13 * x2) + x4 * (s15 + s17 * x2)));
  const double c = 1 - x2 / 2 + x4 * ((c4 + c6 * x2) + x4 * (c8 + c10 * x2) + x8 * ((c12 + c14 * x2) + x4 * c16));
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
