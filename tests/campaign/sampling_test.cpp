// Samples: where the points of each kind lie, and that what else varies makes no difference to an axis.
#include <algorithm>
#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "campaign/sweep/sweep_case.h"

using namespace kadans;

namespace {

SampleAxis uniform_axis(const std::string& name, double low, double high, std::uint32_t steps = 5) {
  return {name, {name}, {.kind = Distribution::Kind::uniform, .of = {low, high}}, steps};
}

const std::vector<std::string> quantities{"ground.friction", "joint.l_knee.torque_scale", "joint.r_knee.torque_scale"};

std::vector<SampleAxis> axes_of(Sampling sampling, bool together) {
  SweepPlan plan;
  plan.sampling = sampling;
  Variation knees{{"joint.*.torque_scale", {}}, {.kind = Distribution::Kind::uniform, .of = {0.9, 1}}};
  knees.distribution.together = together;
  plan.vary.push_back({knees, 3});
  Problems problems("plan.json");
  return sample_axes(plan, {}, quantities, problems);
}

}  // namespace

TEST_CASE("In a Latin hypercube each n-th part of every axis has exactly one of n cases") {
  constexpr std::size_t n = 40;
  const std::vector<SampleAxis> axes{uniform_axis("a", 0, 1), uniform_axis("b", 0, 1), uniform_axis("c", 0, 1)};
  const auto points = sample(Sampling::latin_hypercube, axes, n, 7, "sweep.0");
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    std::set<std::size_t> parts;
    for (const auto& point : points) parts.insert(static_cast<std::size_t>(std::floor(point[axis] * double{n})));
    CHECK(parts.size() == n);
  }
  const auto again = sample(Sampling::latin_hypercube, axes, n, 7, "sweep.0");
  CHECK(points == again);
  CHECK(points != sample(Sampling::latin_hypercube, axes, n, 8, "sweep.0"));
}

TEST_CASE("A grid has all combinations, the ends of a range and all given values among them") {
  SampleAxis values{"v", {"v"}, {.kind = Distribution::Kind::values, .values = {3, 5}}, 2};
  const std::vector<SampleAxis> axes{uniform_axis("a", 2, 4, 3), values};
  REQUIRE(grid_points(axes) == 6);
  const auto points = sample(Sampling::grid, axes, 6, 1, "sweep.0");
  std::set<std::pair<double, double>> seen;
  for (const auto& point : points) {
    const auto settings = settings_at(axes, point);
    seen.insert({settings[0].value, settings[1].value});
  }
  CHECK(seen == std::set<std::pair<double, double>>{{2, 3}, {2, 5}, {3, 3}, {3, 5}, {4, 3}, {4, 5}});
}

TEST_CASE("An axis is drawn the same whatever else varies, and random draws go on where fewer ended") {
  const std::vector<SampleAxis> one{uniform_axis("a", 0, 1)}, two{uniform_axis("b", 0, 1), uniform_axis("a", 0, 1)};
  const auto few = sample(Sampling::random, one, 5, 3, "sweep.0"),
             more = sample(Sampling::random, two, 9, 3, "sweep.0");
  for (std::size_t i = 0; i < few.size(); ++i) CHECK(few[i][0] == more[i][1]);
}

TEST_CASE("A pattern is an axis for each quantity, or one for all, and always one in a grid") {
  CHECK(axes_of(Sampling::random, false).size() == 2);
  CHECK(axes_of(Sampling::random, true).size() == 1);
  const auto grid = axes_of(Sampling::grid, false);
  REQUIRE(grid.size() == 1);
  CHECK(settings_at(grid, {0.5}).size() == 1);  // the pattern itself
  const auto full = quantities_at(grid, {0.5});
  REQUIRE(full.size() == 2);
  CHECK(full[1].name == "joint.r_knee.torque_scale");
  CHECK(full[1].value == doctest::Approx(0.95));
}

TEST_CASE("A pattern that chooses nothing is refused at its place") {
  SweepPlan plan;
  plan.vary.push_back({{{"ground.fricton", {4, 5}}, {}}, 1});
  Problems problems("plan.json");
  (void)sample_axes(plan, {}, quantities, problems);
  try {
    problems.throw_if_any();
    FAIL("not refused");
  } catch (const InputError& error) {
    CHECK(error.problems().front().text().find("plan.json:4:5: unknown quantity 'ground.fricton', did you mean") == 0);
  }
}
