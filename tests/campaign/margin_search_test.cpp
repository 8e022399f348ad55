// The search for a margin: where it ends, and how few values it tries.
#include "campaign/margin/margin_search.h"

#include <vector>

#include <doctest/doctest.h>

namespace margin_search_test {

using kadans::MarginSearch;

namespace {

// What is tried when all values up to `bound` hold, whatever the direction.
std::vector<double> tried(MarginSearch& search, double nominal, double bound) {
  std::vector<double> values;
  for (auto value = search.next(); value; value = search.next()) {
    values.push_back(*value);
    search.tell(std::abs(*value - nominal) <= bound);
    REQUIRE(values.size() < 100);
  }
  return values;
}

}  // namespace

TEST_CASE("A margin lies between two neighbours of the grid, whatever the bound") {
  for (int bound = 0; bound < 40; ++bound) {
    CAPTURE(bound);
    MarginSearch search(0, 0.001, 0.1);
    const std::vector<double> values = tried(search, 0, 0.001 * bound + 1e-4);
    CHECK(search.held() == doctest::Approx(0.001 * bound));
    REQUIRE(search.failed());
    CHECK(*search.failed() == doctest::Approx(0.001 * (bound + 1)));
    CHECK(values.size() <= 13);
  }
}

TEST_CASE("The values are those that a person would write, and steps double until one fails") {
  MarginSearch search(1, 0.05, 4);
  CHECK(tried(search, 1, 0.36) == std::vector<double>{1.05, 1.1, 1.2, 1.4, 1.3, 1.35});
  CHECK(search.held() == 1.35);
  CHECK(*search.failed() == 1.4);
}

TEST_CASE("Downward, the end belongs to the grid, though no whole number of steps leads there") {
  MarginSearch search(0.9, 0.2, 0.25);
  CHECK(tried(search, 0.9, 10) == std::vector<double>{0.7, 0.5, 0.25});
  CHECK(search.held() == 0.25);
  CHECK_FALSE(search.failed());
  MarginSearch short_of(0.9, 0.2, 0.25);
  (void)tried(short_of, 0.9, 0.64);
  CHECK(short_of.held() == 0.3);
  CHECK(*short_of.failed() == 0.25);
}

TEST_CASE("When the first step fails, the nominal value is what holds, to the bit") {
  const double nominal = 1.0 / 3;
  MarginSearch search(nominal, 0.05, 1);
  CHECK(tried(search, nominal, 0).size() == 1);
  CHECK(search.held() == nominal);
}

}  // namespace margin_search_test
