// The same bits on every amd64. sin, cos, exp, log, pow and their like have no exact result; each library rounds them
// in its own way, and the C library rounds in several: at start-up it chooses by the processor between code with and
// without fused multiply-add, whose last digits differ. A robot that falls over multiplies a last digit by a million in
// a second, so that the same seed gave other runs on an older processor.
//
// Therefore the program brings these functions itself. They are defined here under the names that <cmath> declares, and
// stand in the program's table of dynamic symbols, so that the loader binds to them whatever calls them: we, Bullet,
// KDL, LuaJIT (`^` and math.*), plug-ins. tests/project/math_bindings.sh reads the bindings of all that is loaded, and
// fails on a function that is taken from the C library and is not exact by its definition, as sqrt, fmod and floor are.
//
// - What is called often, sine and cosine, is ours: kadans/signal/sine_cosine.h. So are the normal random numbers,
// which
//   hardly ever need a logarithm (kadans/signal/random.h).
// - All else is SLEEF's (N. Shibata and F. Petrogalli, SLEEF: A Portable Vectorized Library of C Standard Mathematical
//   Functions, 2020), by names that begin with Sleef_cinz_ and end with purec: plain C, no fused multiply-add, no
//   choice by the processor, at most one unit in the last place wrong. Names without a prefix choose, Sleef_finz_
//   fuses.
// - Single precision is double precision, rounded.
//
// What else could tell processors apart, and does not here: the compiler must not know these functions, since it would
// put in place of a call with a constant argument what its own library says (KADANS_PORTABLE_MATH in
// cmake/KadansToolchain.cmake has the names, -fno-builtin-NAME is in force everywhere); it must not contract a * b + c
// (-ffp-contract=off); Eigen must not ask the processor for its caches, whose sizes cut large products into sums
// (EIGEN_NO_CPUID).
//
// Unlike the C library's they do not set errno, and lgamma not signgam.
#include <cmath>
#include <numbers>

#include <sleef.h>

#include "kadans/signal/sine_cosine.h"

namespace kadans {

SineCosine sine_cosine_anywhere(double angle_rad) noexcept {
  const Sleef_double_2 both = Sleef_cinz_sincosd1_u10purec(angle_rad);
  return {both.x, both.y};
}

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
KADANS_OF_ONE(atan, u10)
KADANS_OF_TWO(atan2, u10)
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

// SLEEF's exp and pow overflow a billionth before the largest number, the next three where a square or a sum does.
double pow(double x, double y) noexcept { return y == 1 ? x : Sleef_cinz_powd1_u10purec(x, y); }
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
