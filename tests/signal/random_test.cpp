#include "kadans/signal/random.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <doctest/doctest.h>

#include "kadans/signal/state_hash.h"

namespace kadans {
namespace {

TEST_CASE("RandomStream gives the published numbers of xoshiro256** from the state 1, 2, 3, 4") {
  RandomStream stream(std::array<std::uint64_t, 4>{1, 2, 3, 4});
  constexpr std::array<std::uint64_t, 10> published{11520U,
                                                    0U,
                                                    1509978240U,
                                                    1215971899390074240U,
                                                    1216172134540287360U,
                                                    607988272756665600U,
                                                    16172922978634559625U,
                                                    8476171486693032832U,
                                                    10595114339597558777U,
                                                    2904607092377533576U};
  for (const std::uint64_t expected : published) CHECK(stream.next() == expected);
}

TEST_CASE("RandomStream gives the same numbers for a seed and a name on every machine, for ever") {
  // From splitmix64, FNV-1a and xoshiro256** written down a second time in another language.
  RandomStream stream(1, "imu");
  for (const std::uint64_t expected :
       {0xfefe404e2c3cf1cdU, 0x686cb7203840ccd4U, 0xb90a44e3660f9832U, 0x6b1f155e80770e47U}) {
    CHECK(stream.next() == expected);
  }
}

TEST_CASE("uniform numbers fill the range from 0 to below 1 evenly") {
  RandomStream stream(7, "uniform");
  constexpr int count = 100'000;
  std::array<int, 10> bins{};
  double sum = 0, squares = 0;
  bool inside = true;
  for (int i = 0; i < count; ++i) {
    const double x = stream.uniform();
    inside = inside && x >= 0 && x < 1;
    sum += x;
    squares += (x - 0.5) * (x - 0.5);
    ++bins[static_cast<std::size_t>(x * 10)];
  }
  CHECK(inside);
  CHECK(std::abs(sum / count - 0.5) < 0.004);             // four standard errors
  CHECK(std::abs(squares / count - 1.0 / 12.0) < 0.001);  // variance
  for (const int bin : bins) CHECK(std::abs(bin - count / 10) < 400);
}

TEST_CASE("uniform numbers keep to the range asked for") {
  RandomStream stream(7, "range");
  double low = 1e9, high = -1e9;
  for (int i = 0; i < 10'000; ++i) {
    const double x = stream.uniform(-3.0, 5.0);
    low = std::fmin(low, x);
    high = std::fmax(high, x);
  }
  CHECK(low >= -3.0);
  CHECK(low < -2.98);
  CHECK(high <= 5.0);
  CHECK(high > 4.98);
}

TEST_CASE("normal numbers have mean 0, deviation 1, no skew and the tails of the bell curve") {
  RandomStream stream(7, "normal");
  constexpr int count = 200'000;
  double sum = 0, squares = 0, cubes = 0, neighbours = 0, last = 0;
  int beyond_one = 0, beyond_three = 0;
  for (int i = 0; i < count; ++i) {
    const double x = stream.normal();
    sum += x;
    squares += x * x;
    cubes += x * x * x;
    neighbours += x * last;
    last = x;
    if (std::abs(x) > 1) ++beyond_one;
    if (std::abs(x) > 3) ++beyond_three;
  }
  CHECK(std::abs(sum / count) < 0.009);
  CHECK(std::abs(squares / count - 1) < 0.013);
  CHECK(std::abs(cubes / count) < 0.035);
  CHECK(std::abs(neighbours / count) < 0.009);  // each number is independent of the one before
  CHECK(std::abs(beyond_one / double{count} - 0.3173) < 0.0042);
  CHECK(std::abs(beyond_three / double{count} - 0.0027) < 0.0005);
}

TEST_CASE(
    "normal numbers fall into every quarter of a deviation, and beyond the last, as often as the bell curve says") {
  constexpr int count = 1'000'000, per_deviation = 4, half = 4 * per_deviation;
  RandomStream stream(7, "bell");
  std::array<int, 2 * half + 2> bins{};  // the first and the last are the tails
  for (int i = 0; i < count; ++i) {
    const double place = std::floor(stream.normal() * per_deviation);
    ++bins[static_cast<std::size_t>(std::fmin(std::fmax(place, -half - 1), half) + half + 1)];
  }
  const auto below = [](int edge) { return 0.5 * std::erfc(-edge / (per_deviation * std::sqrt(2.0))); };
  double chi_squared = 0;
  for (int i = 0; i < 2 * half + 2; ++i) {
    const double from = i == 0 ? 0 : below(i - half - 1), to = i == 2 * half + 1 ? 1 : below(i - half);
    const double expected = count * (to - from), excess = bins[static_cast<std::size_t>(i)] - expected;
    chi_squared += excess * excess / expected;
  }
  CHECK(chi_squared < 70);  // 33 degrees of freedom: more only once in 5000 seeds
  CHECK(chi_squared > 11);  // nor evener than chance
}

TEST_CASE("normal numbers are the same on every machine") {
  RandomStream stream(1, "imu");
  for (const double expected : {-0x1.5e0feab49001fp-7, 0x1.07d27e0a023cdp+0, -0x1.eb0ecb1796d6dp-1}) {
    CHECK(stream.normal() == expected);
  }
  StateHash hash;  // layers, wedges and tail
  for (int i = 0; i < 100'000; ++i) hash.add(stream.normal());
  CHECK(hash.value() == 0x20c0b99e65e4f2e6U);
}

TEST_CASE("streams are told apart by name and by seed, and repeat for both the same") {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (int name = 0; name < 20; ++name) first.insert(RandomStream(seed, "encoder." + std::to_string(name)).next());
  }
  CHECK(first.size() == 400);
  CHECK(RandomStream(3, "encoder.1").next() == RandomStream(3, "encoder.1").next());
}

TEST_CASE("two streams of one run are uncorrelated") {
  constexpr int count = 50'000;
  for (const auto& [a, b] : {std::pair{"encoder.l_knee", "encoder.r_knee"}, std::pair{"imu", "feet"}}) {
    RandomStream one(1, a), other(1, b);
    double product = 0;
    for (int i = 0; i < count; ++i) product += one.normal() * other.normal();
    CHECK(std::abs(product / count) < 4.0 / std::sqrt(double{count}));
  }
}

TEST_CASE("drawing from one stream does not disturb another") {
  RandomStream alone(1, "imu"), beside(1, "imu"), busy(1, "encoder");
  for (int i = 0; i < 100; ++i) {
    for (int j = 0; j < i; ++j) busy.normal();
    CHECK(alone.normal() == beside.normal());
  }
}

}  // namespace
}  // namespace kadans
