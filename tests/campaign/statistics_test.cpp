// Intervals against published and exact values.
#include "kadans/campaign/statistics.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "kadans/signal/random.h"

using namespace kadans;

TEST_CASE("Wilson's interval has its known values and stays within 0 and 1") {
  // Newcombe, 1998, table I, method 3: 81 of 263, 15 of 148, 0 of 20, 1 of 29.
  const auto check = [](std::size_t hits, std::size_t count, double low, double high) {
    const Interval interval = wilson_interval(hits, count);
    CHECK(interval.low == doctest::Approx(low).epsilon(0.001));
    CHECK(interval.high == doctest::Approx(high).epsilon(0.001));
  };
  check(81, 263, 0.2553, 0.3662);
  check(15, 148, 0.0624, 0.1605);
  check(0, 20, 0.0, 0.1611);
  check(1, 29, 0.0061, 0.1718);
  CHECK(wilson_interval(20, 20).high == 1);
  CHECK(wilson_interval(0, 0).low == 0);
}

TEST_CASE("The bootstrap repeats with its seed and comes near the interval of normal theory") {
  RandomStream random(1, "values");
  std::vector<double> values(400);
  for (double& value : values) value = 3 + 2 * random.normal();
  values.push_back(std::numeric_limits<double>::quiet_NaN());  // a run without a value
  const SampleStatistics s = sample_statistics(values, 5, "m"), again = sample_statistics(values, 5, "m");
  CHECK(s.count == 400);
  CHECK(s.mean_interval.low == again.mean_interval.low);
  CHECK(s.mean_interval.low != sample_statistics(values, 6, "m").mean_interval.low);
  const double half = 1.96 * 2 / std::sqrt(400.0);
  CHECK(s.mean_interval.low == doctest::Approx(s.mean - half).epsilon(0.02));
  CHECK(s.mean_interval.high == doctest::Approx(s.mean + half).epsilon(0.02));
}

TEST_CASE("Quantiles lie between the nearest values") {
  CHECK(quantile({1, 2, 4}, 0.5) == 2);
  CHECK(quantile({1, 2, 4}, 0.75) == 3);
  CHECK(quantile({7}, 0.95) == 7);
  CHECK(sample_statistics({}, 1, "none").count == 0);
}
