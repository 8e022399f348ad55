#include "engine/tick/tick_statistics.h"

#include <doctest/doctest.h>

using kadans::TickStatistics;

TEST_CASE("Percentiles are within a bucket of the exact ones") {
  TickStatistics statistics;
  for (int ns = 1; ns <= 10000; ++ns) statistics.add(ns);
  CHECK(statistics.percentile_ns(0.5) == doctest::Approx(5000).epsilon(0.03));
  CHECK(statistics.percentile_ns(0.99) == doctest::Approx(9900).epsilon(0.03));
  CHECK(statistics.min_ns() == 1);
  CHECK(statistics.max_ns() == 10000);
  CHECK(statistics.mean_ns() == doctest::Approx(5000.5));
  CHECK(statistics.count() == 10000);
}

TEST_CASE("Durations that are alike have that duration as every percentile") {
  for (const std::int64_t ns : std::initializer_list<std::int64_t>{0, 1, 63, 64, 65, 1234, 1000000, 123456789012}) {
    TickStatistics statistics;
    for (int i = 0; i < 7; ++i) statistics.add(ns);
    CHECK(statistics.percentile_ns(0.01) == static_cast<double>(ns));
    CHECK(statistics.percentile_ns(1.0) == static_cast<double>(ns));
  }
}

TEST_CASE("Without any tick every figure is 0") {
  const TickStatistics statistics;
  CHECK(statistics.percentile_ns(0.5) == 0);
  CHECK(statistics.min_ns() == 0);
  CHECK(statistics.max_ns() == 0);
}

TEST_CASE("Counts up to a duration and sums of two are what was added") {
  TickStatistics one, other;
  for (int i = 1; i <= 100; ++i) one.add(i * 1000);
  other.add(5);
  CHECK(one.count_until(50'500) == doctest::Approx(50).epsilon(0.03));
  CHECK(one.count_until(1) == 0);
  one.add_all(other);
  CHECK(one.count() == 101);
  CHECK(one.min_ns() == 5);
  CHECK(one.max_ns() == 100'000);
  CHECK(one.mean_ns() == doctest::Approx((5 + 5'050'000) / 101.0));
}
