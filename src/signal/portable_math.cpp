// The same bits on every amd64. Results of sin, exp, pow and their like have to be rounded, and the C library does it
// in several ways: when a program starts it chooses by the processor between code with and without fused multiply-add,
// whose last digits differ. Contacts make much of a last digit, so that a seed gave another run on an older processor.
//
// Therefore the program brings these functions itself. They are defined here under the names that <cmath> declares, and
// stand in the program's table of dynamic symbols, so that the loader binds to them whatever calls them: we, Bullet,
// KDL, LuaJIT (`^` and math.*), plug-ins. tests/project/math_bindings.sh reads the bindings of all that is loaded. It
// fails on a function of the C library that is not exact by its definition, as sqrt, fmod and floor are.
//
// Sine, cosine and the angle of a point, which are called most, are ours (signal/sine_cosine.h, arc_tangent below).
// Normal random numbers hardly ever need a logarithm (kadans/signal/random.h). All else is SLEEF's (N. Shibata and
// F. Petrogalli, SLEEF: A Portable Vectorized Library of C Standard Mathematical Functions, 2020), by the names that
// begin with Sleef_cinz_ and end with purec: plain C without fused multiply-add, wrong by at most one unit in the last
// place. The names without cinz_ and purec choose by the processor, those with finz_ fuse. Single precision is double
// precision, rounded.
//
// What else would make results differ, and is kept out:
// - A compiler that knows these functions puts its own result in place of a call with a constant argument. It is told
//   not to know them (KADANS_PORTABLE_MATH in cmake/KadansToolchain.cmake).
// - A compiler may contract a * b + c into one operation: -ffp-contract=off.
// - Eigen cuts large products by the sizes of the processor's caches, unless it may not ask for them: EIGEN_NO_CPUID.
//   The Eigen in KDL and pagmo does ask, and cuts nothing that has fewer than 48 rows and columns.
//
// Unlike the C library's these functions do not set errno, nor lgamma signgam. Those of complex numbers and of long
// double are left to the C library: nothing that decides a run calls them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <sleef.h>

#include "sine_cosine.h"

namespace kadans {
namespace {

// The angle of a point by plain arithmetic, the same bits with every compiler and on every processor: the atan2 that
// the program defines. The estimator needs four per tick.
//
// The smaller of the two coordinates over the larger is the tangent of at most 45 degrees. One of the four angles whose
// tangents are 0, 1/4, 1/2 and 1 is subtracted, the one that leaves at most 9.4 degrees, by tan(a - b) = (n - t d) / (d
// + t n). The numerator is exact, because t d is a power of two times d and between half of n and twice n. The errors
// of denominator and quotient are computed (T. Dekker, A floating-point technique for extending the available
// precision, 1971). The rest is the series q - q^3 / 3 + ... to the 19th power. The parts are added up, each in two
// numbers.
//
// Error below 0.6 units in the last place.
namespace arc_tangent_parts {

// A number, and what it lacks in its last place.
struct Sum {
  double high, low;
};

struct Arc {
  double tangent;
  Sum angle_rad;
};

constexpr Arc arcs[]{{0, {0, 0}},
                     {0.25, {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57}},
                     {0.5, {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56}},
                     {1, {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}}};
constexpr Sum quarter_rad{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Sum half_rad{0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};

// The first 26 bits.
double head(double x) noexcept {
  const double spread = 0x1.000002p+27 * x;
  return spread - (spread - x);
}

Sum quotient(double numerator, const Sum& denominator) noexcept {
  const double d = denominator.high, inverse = 1 / d, q = numerator * inverse;
  const double q_head = head(q), d_head = head(d), q_tail = q - q_head, d_tail = d - d_head;
  const double product = q * d;
  const double missing = ((q_head * d_head - product) + q_head * d_tail + q_tail * d_head) + q_tail * d_tail;
  return {q, (((numerator - product) - missing) - q * denominator.low) * inverse};
}

// Of a quotient of at most 0.166, less the quotient itself.
double series(double q) noexcept {
  const double x = q * q, x2 = x * x, x4 = x2 * x2;
  const double first = (-1.0 / 3 + x / 5) + x2 * (-1.0 / 7 + x / 9);
  const double second = (-1.0 / 11 + x / 13) + x2 * (-1.0 / 15 + x / 17);
  return q * x * (first + x4 * (second + x4 * (-1.0 / 19)));
}

// a + sign b; a is the larger one.
Sum add(const Sum& a, double sign, const Sum& b) noexcept {
  const double b_high = sign * b.high, high = a.high + b_high;
  return {high, ((a.high - high) + b_high) + (a.low + sign * b.low)};
}

// Of a tangent of at most 1.
Sum angle_rad(double numerator, double denominator) noexcept {
  const Arc& arc =
      arcs[(numerator >= 0.125 * denominator) + (numerator > 0.366 * denominator) + (numerator > 0.716 * denominator)];
  const double more = arc.tangent * numerator, sum = denominator + more;
  const Sum q = quotient(numerator - arc.tangent * denominator, {sum, (denominator - sum) + more});
  return add(arc.angle_rad, 1, {q.high, q.low + series(q.high)});
}

}  // namespace arc_tangent_parts

// In (-pi, pi), of coordinates whose sizes lie between 2^-300 and 2^300.
double arc_tangent(double y, double x) noexcept {
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

}  // namespace

SineCosine sine_cosine_anywhere(double angle_rad) noexcept {
  const Sleef_double_2 both = Sleef_cinz_sincosd1_u10purec(angle_rad);
  return {both.x, both.y};
}

namespace {

// Neither zero nor so great or small that its square would be off the scale.
bool is_ordinary(double x) noexcept { return std::fabs(x) > 0x1p-300 && std::fabs(x) < 0x1p300; }

}  // namespace
}  // namespace kadans

// NAME(x) by SLEEF with at most `ulp10` tenths of a unit in the last place, and NAMEf(x) by that.
#define KADANS_OF_ONE(name, ulp10)                                                   \
  double name(double x) noexcept { return Sleef_cinz_##name##d1_##ulp10##purec(x); } \
  float name##f(float x) noexcept { return static_cast<float>(name(static_cast<double>(x))); }
#define KADANS_OF_TWO(name, ulp10)                                                                \
  double name(double x, double y) noexcept { return Sleef_cinz_##name##d1_##ulp10##purec(x, y); } \
  float name##f(float x, float y) noexcept {                                                      \
    return static_cast<float>(name(static_cast<double>(x), static_cast<double>(y)));              \
  }

extern "C" {

double sin(double x) noexcept { return kadans::sine_cosine(x).sine; }
double cos(double x) noexcept { return kadans::sine_cosine(x).cosine; }
void sincos(double x, double* sine, double* cosine) noexcept {
  const auto [s, c] = kadans::sine_cosine(x);
  *sine = s;
  *cosine = c;
}
float sinf(float x) noexcept { return static_cast<float>(sin(static_cast<double>(x))); }
float cosf(float x) noexcept { return static_cast<float>(cos(static_cast<double>(x))); }
void sincosf(float x, float* sine, float* cosine) noexcept {
  const auto [s, c] = kadans::sine_cosine(static_cast<double>(x));
  *sine = static_cast<float>(s);
  *cosine = static_cast<float>(c);
}

KADANS_OF_ONE(tan, u10)
KADANS_OF_ONE(asin, u10)
KADANS_OF_ONE(acos, u10)
KADANS_OF_ONE(sinh, u10)
KADANS_OF_ONE(cosh, u10)
KADANS_OF_ONE(tanh, u10)
KADANS_OF_ONE(atanh, u10)
KADANS_OF_ONE(exp, u10)
KADANS_OF_ONE(exp2, u10)
KADANS_OF_ONE(expm1, u10)
KADANS_OF_ONE(log, u10)
KADANS_OF_ONE(log2, u10)
KADANS_OF_ONE(log10, u10)
KADANS_OF_ONE(cbrt, u10)
KADANS_OF_TWO(hypot, u05)
KADANS_OF_ONE(erf, u10)
KADANS_OF_ONE(erfc, u15)
KADANS_OF_ONE(tgamma, u10)
KADANS_OF_ONE(lgamma, u10)

double atan(double x) noexcept {
  return kadans::is_ordinary(x) ? kadans::arc_tangent(x, 1) : Sleef_cinz_atand1_u10purec(x);
}
double atan2(double y, double x) noexcept {
  if (kadans::is_ordinary(y) && kadans::is_ordinary(x)) return kadans::arc_tangent(y, x);
  return y == 0 && x > 0 ? y : Sleef_cinz_atan2d1_u10purec(y, x);
}
float atanf(float x) noexcept { return static_cast<float>(atan(static_cast<double>(x))); }
float atan2f(float y, float x) noexcept {
  return static_cast<float>(atan2(static_cast<double>(y), static_cast<double>(x)));
}

// SLEEF's exp and pow overflow a billionth before the largest number, the next three where a square or a sum does.
double pow(double x, double y) noexcept {
  if (y == 2) return x * x;  // what scripts mostly ask for
  return y == 1 ? x : Sleef_cinz_powd1_u10purec(x, y);
}
double asinh(double x) noexcept {
  if (std::fabs(x) < 1e150) return Sleef_cinz_asinhd1_u10purec(x);
  return std::copysign(log(std::fabs(x)) + std::numbers::ln2, x);
}
double acosh(double x) noexcept { return x < 1e150 ? Sleef_cinz_acoshd1_u10purec(x) : log(x) + std::numbers::ln2; }
double log1p(double x) noexcept { return x < 1e300 ? Sleef_cinz_log1pd1_u10purec(x) : log(x); }
float powf(float x, float y) noexcept {
  return static_cast<float>(pow(static_cast<double>(x), static_cast<double>(y)));
}
float asinhf(float x) noexcept { return static_cast<float>(asinh(static_cast<double>(x))); }
float acoshf(float x) noexcept { return static_cast<float>(acosh(static_cast<double>(x))); }
float log1pf(float x) noexcept { return static_cast<float>(log1p(static_cast<double>(x))); }

}  // extern "C"

#undef KADANS_OF_ONE
#undef KADANS_OF_TWO
