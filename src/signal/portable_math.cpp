// The same bits on every amd64. Results of sin, exp, pow and their like have to be rounded, and the C library does it
// in several ways: when a program starts it chooses by the processor between code with and without fused multiply-add,
// whose last digits differ. Contacts make much of a last digit, so that a seed gave another run on an older processor.
//
// Therefore the program brings these functions itself. They are defined here under the names that <cmath> declares, and
// stand in the program's table of dynamic symbols, so that the loader binds to them whatever calls them: we, Bullet,
// KDL, LuaJIT (`^` and math.*), plug-ins. tests/project/math_bindings.sh reads the bindings of all that is loaded. It
// fails on a function of the C library that is not exact by its definition, as sqrt, fmod and floor are.
//
// Sine, cosine and the angle of a point, which are called most, are ours (signal/sine_cosine.h, arc_tangent.h).
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
#include <cmath>
#include <numbers>

#include <sleef.h>

#include "arc_tangent.h"
#include "sine_cosine.h"

namespace kadans {

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
