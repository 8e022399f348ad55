// The search finds known optima, asks the same again when it is asked again, and goes on from scores alone.
#include "campaign/tuning/cma_es.h"

#include <cmath>
#include <stdexcept>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

// A narrow valley askew to the axes, its floor at (0.7, 0.4).
double valley(const Point& p) {
  const double along = (p[0] - 0.7) + (p[1] - 0.4), across = (p[0] - 0.7) - (p[1] - 0.4);
  return along * along + 100 * across * across;
}

template <typename Score>
void go_on(CmaEs& search, std::size_t generations, Score score) {
  for (std::size_t i = 0; i < generations; ++i) {
    std::vector<double> scores;
    for (const Point& point : search.ask()) scores.push_back(score(point));
    search.tell(scores);
  }
}

}  // namespace

TEST_CASE("CMA-ES finds the floor of a narrow valley askew to the axes, and begins where it was told") {
  CmaEs search({.start = {0.2, 0.9}, .population = 8, .generations = 40, .step = 0.25, .seed = 3});
  REQUIRE(search.ask() == std::vector<Point>{{0.2, 0.9}});
  go_on(search, 41, valley);
  CHECK(search.best()[0] == doctest::Approx(0.7).epsilon(0.01));
  CHECK(search.best()[1] == doctest::Approx(0.4).epsilon(0.01));
  CHECK(search.ask().empty());
}

TEST_CASE("CMA-ES finds an optimum in one dimension and at the edge of the cube, and never leaves it") {
  CmaEs search({.start = {0.1}, .population = 6, .generations = 15, .step = 0.25, .seed = 1});
  const auto check_inside = [](const Point& p) {
    CHECK((p[0] >= 0 && p[0] <= 1));
    return (p[0] - 0.63) * (p[0] - 0.63);
  };
  go_on(search, 16, check_inside);
  CHECK(search.best()[0] == doctest::Approx(0.63).epsilon(0.01));
  CmaEs edge({.start = {0.5, 0.5}, .population = 6, .generations = 25, .step = 0.25, .seed = 1});
  go_on(edge, 26, [](const Point& p) { return p[0] - p[1]; });
  CHECK(edge.best()[0] < 0.02);
  CHECK(edge.best()[1] > 0.98);
}

TEST_CASE(
    "A search goes on from scores alone as if it had never ended, its points depend on nothing but seed and scores") {
  const CmaEs::Config config{.start = {0.2, 0.9}, .population = 7, .generations = 10, .step = 0.25, .seed = 9};
  CmaEs whole(config), again(config);
  go_on(whole, 6, valley);
  std::vector<std::vector<double>> told;
  CmaEs first(config);
  for (int i = 0; i < 6; ++i) {
    std::vector<double> scores;
    for (const Point& point : first.ask()) scores.push_back(valley(point));
    first.tell(scores);
    told.push_back(scores);
  }
  for (const auto& scores : told) again.tell(scores);
  CHECK(again.ask() == whole.ask());
  CHECK(again.ask() == again.ask());
  CHECK(again.best_score() == whole.best_score());
  CmaEs::Config other = config;
  other.seed = 10;
  CmaEs different(other);
  go_on(different, 6, valley);
  CHECK(different.ask() != whole.ask());
}

TEST_CASE("What is no search is refused") {
  CHECK_THROWS_AS(CmaEs({.start = {}}), std::invalid_argument);
  CHECK_THROWS_AS(CmaEs({.start = {0.5}, .population = 4}), std::invalid_argument);
  CmaEs search({.start = {0.5}});
  CHECK_THROWS_AS(search.tell({1, 2}), std::invalid_argument);
}
