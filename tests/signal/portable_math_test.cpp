// The functions of src/signal/portable_math.cpp against MPFR, which rounds correctly.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>

#include <doctest/doctest.h>
#include <mpfr.h>
#include <sleef.h>

#include "kadans/signal/random.h"
#include "kadans/signal/state_hash.h"
#include "signal/sine_cosine.h"

namespace kadans {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

int samples() {
  return std::getenv("KADANS_SOAK") != nullptr ? 100'000 : 3'000;  // NOLINT(concurrency-mt-unsafe): one thread
}

// The numbers of one width: bits of their fraction, and the exponent of the smallest of them.
struct Width {
  int digits, least;
};
constexpr Width in_double{53, -1074}, in_single{24, -149};

// A number of 200 bits.
class Exact {
 public:
  explicit Exact(double value) noexcept {
    mpfr_init2(value_, 200);
    mpfr_set_d(value_, value, MPFR_RNDN);
  }
  ~Exact() { mpfr_clear(value_); }
  Exact(const Exact&) = delete;
  Exact& operator=(const Exact&) = delete;
  mpfr_ptr get() noexcept { return value_; }

  // How far `found` is off, in units of its last place; infinite when it is of another kind or a zero of another sign.
  // The number is gone then.
  double units_to(double found, Width width) noexcept {
    const double rounded = width.digits == 53 ? mpfr_get_d(value_, MPFR_RNDN) : double{mpfr_get_flt(value_, MPFR_RNDN)};
    if (std::isnan(rounded) || std::isnan(found)) return std::isnan(rounded) && std::isnan(found) ? 0 : infinite;
    if (std::isinf(rounded) || std::isinf(found)) return rounded == found ? 0 : infinite;
    if (rounded == 0 && found == 0) return std::signbit(rounded) == std::signbit(found) ? 0 : infinite;
    const int exponent = mpfr_zero_p(value_) != 0 ? width.least : static_cast<int>(mpfr_get_exp(value_));
    mpfr_sub_d(value_, value_, found, MPFR_RNDN);
    mpfr_mul_2si(value_, value_, -std::max(exponent - width.digits, width.least), MPFR_RNDN);
    return std::fabs(mpfr_get_d(value_, MPFR_RNDN));
  }

 private:
  mpfr_t value_;
};

int log_of_gamma(mpfr_ptr result, mpfr_srcptr x, mpfr_rnd_t rounding) {
  int sign = 0;
  return mpfr_lgamma(result, &sign, x, rounding);
}

struct OfOne {
  const char* name;
  double (*ours)(double);
  float (*ours_in_single)(float);
  int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
  double low, high;  // where most of the samples lie
  double units_max = 1;
};
constexpr std::array<OfOne, 24> of_one{{{"sin", sin, sinf, mpfr_sin, -10, 10},
                                        {"cos", cos, cosf, mpfr_cos, -10, 10},
                                        {"tan", tan, tanf, mpfr_tan, -10, 10},
                                        {"asin", asin, asinf, mpfr_asin, -1, 1},
                                        {"acos", acos, acosf, mpfr_acos, -1, 1},
                                        {"atan", atan, atanf, mpfr_atan, -20, 20},
                                        {"sinh", sinh, sinhf, mpfr_sinh, -20, 20},
                                        {"cosh", cosh, coshf, mpfr_cosh, -20, 20},
                                        {"tanh", tanh, tanhf, mpfr_tanh, -20, 20},
                                        {"asinh", asinh, asinhf, mpfr_asinh, -20, 20},
                                        {"acosh", acosh, acoshf, mpfr_acosh, 1, 20},
                                        {"atanh", atanh, atanhf, mpfr_atanh, -1, 1},
                                        {"exp", exp, expf, mpfr_exp, -740, 709},
                                        {"exp2", exp2, exp2f, mpfr_exp2, -1080, 1030},
                                        {"expm1", expm1, expm1f, mpfr_expm1, -40, 40},
                                        {"log", log, logf, mpfr_log, 0, 4},
                                        {"log2", log2, log2f, mpfr_log2, 0, 4},
                                        {"log10", log10, log10f, mpfr_log10, 0, 4},
                                        {"log1p", log1p, log1pf, mpfr_log1p, -1, 3},
                                        {"cbrt", cbrt, cbrtf, mpfr_cbrt, -20, 20},
                                        {"erf", erf, erff, mpfr_erf, -6, 6},
                                        {"erfc", erfc, erfcf, mpfr_erfc, -6, 26, 1.5},
                                        {"tgamma", tgamma, tgammaf, mpfr_gamma, -20, 171},
                                        {"lgamma", lgamma, lgammaf, log_of_gamma, 0, 200}}};

struct OfTwo {
  const char* name;
  double (*ours)(double, double);
  int (*exact)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);
  double low, high;  // of the first; the second between -10 and 10
  double units_max = 1;
};
constexpr std::array<OfTwo, 3> of_two{{{"atan2", atan2, mpfr_atan2, -10, 10, 0.6},
                                       {"pow", pow, mpfr_pow, 0, 40},
                                       {"hypot", hypot, mpfr_hypot, -10, 10, 0.6}}};

double error_of(const OfOne& function, double x) {
  Exact exact(x);
  function.exact(exact.get(), exact.get(), MPFR_RNDN);
  return exact.units_to(function.ours(x), in_double);
}

double error_of(const OfOne& function, float x) {
  Exact exact(x);
  function.exact(exact.get(), exact.get(), MPFR_RNDN);
  return exact.units_to(function.ours_in_single(x), in_single);
}

double error_of(const OfTwo& function, double x, double y) {
  Exact exact(x), other(y);
  function.exact(exact.get(), exact.get(), other.get(), MPFR_RNDN);
  return exact.units_to(function.ours(x, y), in_double);
}

struct Worst {
  double units = 0, x = 0, y = 0;
  void look(double found, double at_x, double at_y = 0) {
    if (!(found <= units)) *this = {found, at_x, at_y};
  }
};

// A number of any size and sign.
double anything(RandomStream& random) { return std::bit_cast<double>(random.next()); }

bool is_gamma(const OfOne& function) { return std::string_view(function.name).ends_with("gamma"); }

}  // namespace

TEST_CASE("every function is within a unit in the last place of the exact result where it is mostly used") {
  RandomStream random(1, "mostly");
  for (const OfOne& function : of_one) {
    CAPTURE(std::string(function.name));
    Worst worst, single;
    for (int i = 0; i < samples(); ++i) {
      const double x = random.uniform(function.low, function.high);
      worst.look(error_of(function, x), x);
      single.look(error_of(function, static_cast<float>(x)), x);
    }
    CAPTURE(worst.x);
    CHECK(worst.units <= function.units_max);
    CAPTURE(single.x);
    CHECK(single.units <= 0.51);
  }
  for (const OfTwo& function : of_two) {
    CAPTURE(std::string(function.name));
    Worst worst;
    for (int i = 0; i < samples(); ++i) {
      const double x = random.uniform(function.low, function.high), y = random.uniform(-10, 10);
      worst.look(error_of(function, x, y), x, y);
    }
    CAPTURE(worst.x);
    CAPTURE(worst.y);
    CHECK(worst.units <= function.units_max);
  }
}

TEST_CASE("numbers of any size give the exact result within a unit in the last place, the least within 1.2") {
  RandomStream random(1, "anything");
  for (const OfOne& function : of_one) {
    if (is_gamma(function)) continue;  // asked for its own range alone
    CAPTURE(std::string(function.name));
    Worst worst;
    for (int i = 0; i < samples(); ++i) {
      const double x = anything(random);
      worst.look(error_of(function, x), x);
    }
    CAPTURE(worst.x);
    CHECK(worst.units <= 1.2);
  }
}

TEST_CASE("the angle of a point in any direction at any distance is exact to 0.6 units in the last place") {
  RandomStream random(1, "points");
  Worst worst;
  for (int i = 0; i < 4 * samples(); ++i) {
    const auto coordinate = [&] {
      return std::ldexp(random.uniform(-1, 1), static_cast<int>(random.uniform(-250, 250)));
    };
    const double x = coordinate(), y = i % 2 == 0 ? coordinate() : x * random.uniform(-2, 2);
    worst.look(error_of(of_two[0], y, x), y, x);
  }
  CAPTURE(worst.x);
  CAPTURE(worst.y);
  CHECK(worst.units < 0.6);
}

TEST_CASE("what is zero, infinite, no number or at the end of the numbers gives what the C standard asks for") {
  constexpr double largest = std::numeric_limits<double>::max(), smallest = std::numeric_limits<double>::denorm_min();
  constexpr std::array<double, 18> special{0.0,      -0.0,      1,   -1,  2,    -2,      3,        -3,       0.5,
                                           infinite, -infinite, nan, 1e3, -1e3, largest, -largest, smallest, -smallest};
  for (const OfOne& function : of_one) {
    if (is_gamma(function)) continue;
    for (const double x : special) {
      CAPTURE(std::string(function.name));
      CAPTURE(x);
      CHECK(error_of(function, x) <= 1);
    }
  }
  for (const OfTwo& function : of_two) {
    for (const double x : special) {
      for (const double y : special) {
        CAPTURE(std::string(function.name));
        CAPTURE(x);
        CAPTURE(y);
        CHECK(error_of(function, x, y) <= 1);
      }
    }
  }
}

TEST_CASE("a power that is a whole number is exact") {
  for (int base = 1; base <= 10; ++base) {
    double product = 1;
    for (int power = 0; power <= 15; ++power, product *= base) CHECK(pow(base, power) == product);
  }
}

TEST_CASE("a sine and a cosine together are those alone, within 0.8 units, near multiples of a quarter turn too") {
  RandomStream random(1, "turns");
  Worst sine, cosine;
  bool same = true;
  for (int i = 0; i < 4 * samples(); ++i) {
    const double turns = std::floor(random.uniform(-6400, 6400)),
                 near = std::ldexp(1, -static_cast<int>(53 * random.uniform()));
    const double x = 0.5 * std::numbers::pi * (turns + random.uniform(-1, 1) * near);
    const SineCosine found = sine_cosine(x);
    double s = 0, c = 0;
    sincos(x, &s, &c);
    same = same && found.sine == sin(x) && found.cosine == cos(x) && s == sin(x) && c == cos(x);
    if (std::fabs(x) >= 1e4) continue;
    sine.look(error_of(of_one[0], x), x);
    cosine.look(error_of(of_one[1], x), x);
  }
  for (int quarters = 1; quarters * std::numbers::pi / 2 < 1e4; ++quarters) {
    Exact turned(quarters);  // the number next to a multiple: one of the two is nearly nothing
    Exact pi(0);
    mpfr_const_pi(pi.get(), MPFR_RNDN);
    mpfr_mul(turned.get(), turned.get(), pi.get(), MPFR_RNDN);
    const double x = mpfr_get_d(turned.get(), MPFR_RNDN) / 2;
    sine.look(error_of(of_one[0], x), x);
    cosine.look(error_of(of_one[1], x), x);
  }
  CHECK(same);
  CAPTURE(sine.x);
  CHECK(sine.units < 0.8);
  CAPTURE(cosine.x);
  CHECK(cosine.units < 0.8);
}

// Where the last place of ours is not that of the exact result.
TEST_CASE("the compiler puts no result of its own in place of a call") {
  volatile double x = 181.31191679454537;
  CHECK(error_of(of_one[12], x) > 0.9);
  CHECK(std::exp(181.31191679454537) == std::exp(x));
}

#ifdef __x86_64__
TEST_CASE("the results are the same bits on every amd64") {
  RandomStream random(1, "bits");
  StateHash hash;
  for (int i = 0; i < 1000; ++i) {
    for (const OfOne& function : of_one) hash.add(function.ours(random.uniform(function.low, function.high)));
    for (const OfTwo& function : of_two) {
      const double x = random.uniform(function.low, function.high);
      hash.add(function.ours(x, random.uniform(-10, 10)));
    }
  }
  // SLEEF's last digits are a version's own: 3.5 is Debian 12's, 3.8 Debian 13's. Golden hashes say theirs.
  if constexpr (SLEEF_VERSION_MAJOR == 3 && SLEEF_VERSION_MINOR == 5) CHECK(hash.value() == 0x31e64610f4fab0d1U);
  if constexpr (SLEEF_VERSION_MAJOR == 3 && SLEEF_VERSION_MINOR == 8) CHECK(hash.value() == 0xc165d9092bdf18d3U);
}
#endif

}  // namespace kadans
