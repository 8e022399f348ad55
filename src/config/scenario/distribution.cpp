#include "distribution.h"

#include <algorithm>
#include <cmath>

namespace kadans {
namespace {

constexpr double cut_off = 4;  // standard deviations

struct Spread {
  const char* key;
  Distribution::Kind kind;
  const char* doc;
};
constexpr std::array<Spread, 3> spreads{{
    {"uniform", Distribution::Kind::uniform, "low and high; all values between them are equally likely"},
    {"log_uniform", Distribution::Kind::log_uniform,
     "low and high; the logarithms of the values between them are equally likely"},
    {"normal", Distribution::Kind::normal,
     "mean and standard deviation; the distribution is cut off at four standard deviations"},
}};

void verify(const Fields& f, const Spread& spread, const Distribution& distribution) {
  const auto [low, high] = distribution.of;
  const auto refuse = [&](const std::string& what) { f.refuse(spread.key, what); };
  if (spread.kind == Distribution::Kind::normal) {
    if (high < 0) refuse(": the standard deviation is " + number_text(high) + ", must not be negative");
    return;
  }
  if (low > high) refuse(": low is " + number_text(low) + ", must be at most high, " + number_text(high));
  if (spread.kind == Distribution::Kind::log_uniform && low <= 0)
    refuse(": low is " + number_text(low) + ", must be above 0");
}

}  // namespace

double normal_quantile(double p) noexcept {
  const double q = p - 0.5;
  if (std::abs(q) <= 0.425) {
    const double r = 0.180625 - q * q;
    return q * (((59.10937472 * r + 159.29113202) * r + 50.434271938) * r + 3.3871327179) /
           (((67.1875636 * r + 78.757757664) * r + 17.895169469) * r + 1);
  }
  const double tail = std::sqrt(-std::log(q < 0 ? p : 1 - p));
  double value = 0;
  if (tail <= 5) {
    const double r = tail - 1.6;
    value = (((0.17023821103 * r + 1.3067284816) * r + 2.75681539) * r + 1.4234372777) /
            ((0.12021132975 * r + 0.7370016425) * r + 1);
  } else {
    const double r = tail - 5;
    value = (((0.017337203997 * r + 0.42868294337) * r + 3.081226386) * r + 6.657905115) /
            ((0.012258202635 * r + 0.24197894225) * r + 1);
  }
  return q < 0 ? -value : value;
}

double Distribution::at(double u) const noexcept {
  switch (kind) {
    case Kind::uniform:
      return of[0] + u * (of[1] - of[0]);
    case Kind::log_uniform:
      return of[0] * std::exp(u * std::log(of[1] / of[0]));
    case Kind::normal: {
      constexpr double least = 3.1671241833119863e-5;  // of the standard normal, at -4
      return of[0] + of[1] * std::clamp(normal_quantile(std::clamp(u, least, 1 - least)), -cut_off, cut_off);
    }
    case Kind::values:
      return values[std::min(values.size() - 1, static_cast<std::size_t>(u * static_cast<double>(values.size())))];
  }
  return 0;
}

void distribution_fields(Fields& f, Distribution& distribution) {
  int given = 0;
  for (const Spread& spread : spreads) {
    std::array<double, 2> of{};
    if (!f.numbers(spread.key, of, {}, spread.doc)) continue;
    ++given;
    distribution.kind = spread.kind;
    distribution.of = of;
    verify(f, spread, distribution);
  }
  if (f.number_list("values", distribution.values, {1, 10'000}, {}, "one of these values; all are equally likely")) {
    ++given;
    distribution.kind = Distribution::Kind::values;
  }
  f.boolean("together", distribution.together,
            "all quantities that the pattern matches have the same value (default: each has its own)");
  if (!f.reading() || given == 1) return;
  const bool tried = f.has("uniform") || f.has("log_uniform") || f.has("normal") || f.has("values");
  if (given > 1 || !tried) f.refuse(" must have one of uniform, log_uniform, normal and values");
}

void variation_fields(Fields& f, std::string_view name, std::vector<Variation>& variations) {
  f.map(name, "quantities that each seed draws anew, by a pattern of their names", [&](Fields& e) {
    Variation variation{.pattern = {e.key(), e.key_place()}, .distribution = {}};
    distribution_fields(e, variation.distribution);
    if (e.reading()) variations.push_back(std::move(variation));
  });
}

}  // namespace kadans
