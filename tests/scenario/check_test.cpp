#include "kadans/scenario/check.h"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

CheckResult judged(const ScenarioCheck& check, const std::vector<double>& values) {
  Check judge(check, 1);
  double time_s = 0;
  for (const double value : values) {
    const std::vector<double> row{99, value};  // the check looks at signal 1
    judge.update(time_s, row);
    time_s += 1;
  }
  return judge.result();
}

}  // namespace

TEST_CASE("always holds while every value is within bounds, and tells the worst") {
  const ScenarioCheck check{.name = "tilt", .kind = CheckKind::always, .signal = "x", .min = -1, .max = 2};
  CheckResult result = judged(check, {0, 1.5, -0.9, 0});
  CHECK(result.passed);
  CHECK(result.name == "tilt");
  CHECK(result.value == -0.9);  // nearest to its bound
  CHECK(result.at_s == 2);
  result = judged(check, {0, 2.5, 7, 0});
  CHECK_FALSE(result.passed);
  CHECK(result.value == 7);
  CHECK(result.at_s == 2);
}

TEST_CASE("always fails on NaN") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::always, .signal = "x", .max = 2};
  CHECK_FALSE(judged(check, {0, std::nan(""), 0}).passed);
}

TEST_CASE("never fails when a value comes within the bounds") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::never, .signal = "x", .min = 3};
  CHECK(judged(check, {0, 2.9, 1}).passed);
  const CheckResult result = judged(check, {0, 3.5, 1});
  CHECK_FALSE(result.passed);
  CHECK(result.value == 3.5);
}

TEST_CASE("eventually wants one value within the bounds") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::eventually, .signal = "x", .max = 0.5};
  const CheckResult result = judged(check, {1, 0.4, 1});
  CHECK(result.passed);
  CHECK(result.at_s == 1);
  CHECK_FALSE(judged(check, {1, 0.6, 1}).passed);
}

TEST_CASE("at_end looks at the last value alone") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::at_end, .signal = "x", .min = 1};
  CHECK(judged(check, {0, 0, 1}).passed);
  CHECK_FALSE(judged(check, {1, 1, 0}).passed);
}

TEST_CASE("A window leaves out what is before and after it, one that is never reached does not pass") {
  ScenarioCheck check{.name = "n", .kind = CheckKind::always, .signal = "x", .max = 1, .from_s = 1, .until_s = 2};
  CHECK(judged(check, {9, 1, 1, 9}).passed);
  CHECK_FALSE(judged(check, {0, 0, 9, 0}).passed);
  check.from_s = check.until_s = 100;
  CHECK_FALSE(judged(check, {0, 0}).passed);
}
