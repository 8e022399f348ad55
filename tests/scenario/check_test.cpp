// What each kind of check demands, on a signal within bounds and on a condition in Lua.
#include <cmath>

#include <doctest/doctest.h>

#include "scenario/judge/checks.h"

using namespace kadans;

namespace {

// Signals x and y; one value of x a second, y counts the ticks.
CheckResult judged(const ScenarioCheck& check, const std::vector<double>& values) {
  const double unused = 0;
  SignalTable signals;
  signals.add({"plant.x", "", ""}, &unused);
  signals.add({"x", "", ""}, &unused);
  signals.add({"plant.y", "", ""}, &unused);
  Checks checks(signals, {check});
  double time_s = 0;
  for (const double value : values) {
    checks.update(time_s, std::vector<double>{99, value, time_s});
    time_s += 1;
  }
  return checks.results().front();
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

TEST_CASE("A condition may look at a signal's value one tick before") {
  const ScenarioCheck check{.name = "steps", .kind = CheckKind::always, .that = "abs(x - last.x) <= 1"};
  CHECK(judged(check, {5, 6, 5.5, 5}).passed);
  const CheckResult result = judged(check, {5, 6, 7.5, 7});
  CHECK_FALSE(result.passed);
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

TEST_CASE("A condition holds or not, over several signals and the time") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::always, .that = "x < 2 and abs(y - time_s) < 1e-9"};
  CHECK(judged(check, {0, 1.5, 1}).passed);
  const CheckResult result = judged(check, {0, 2.5, 7, 0});
  CHECK_FALSE(result.passed);
  CHECK(result.value == 2.5);  // the first signal, when it first did not hold
  CHECK(result.at_s == 1);
}

TEST_CASE("A name that holds what is otherwise an operator is a signal's where there is such a signal") {
  const double unused = 0;
  SignalTable signals;
  for (const char* name : {"plant.left-knee.rad", "plant.left", "knee.rad", "arm/1.rad", "arm"})
    signals.add({name, "", ""}, &unused);
  const auto holds = [&](const char* that) {
    Checks checks(signals, {{.name = "n", .kind = CheckKind::always, .that = that}});
    checks.update(0, std::vector<double>{5, 9, 2, 3, 8});
    return checks.results().front().passed;
  };
  CHECK(holds("left-knee.rad == 5 and last.left-knee.rad-1 == 4"));
  CHECK(holds("left - knee.rad == 7 and left-1 == 8"));
  CHECK(holds("arm/1.rad == 3 and arm/2 == 4 and arm/1.0 == 8 and (arm/1.rad)*knee.rad==6"));
}

TEST_CASE("within wants the condition soon after each time that `when` becomes true") {
  const ScenarioCheck check{
      .name = "n", .kind = CheckKind::within, .that = "x > 5", .when = "x < 1 and x > -1", .within_s = 2};
  CHECK(judged(check, {2, 0, 2, 9, 2, 0, 2, 6}).passed);
  const CheckResult late = judged(check, {2, 0, 2, 9, 2, 0, 2, 2, 9});
  CHECK_FALSE(late.passed);
  CHECK(late.at_s == 8);
  const CheckResult idle = judged(check, {2, 2, 9});
  CHECK_FALSE(idle.passed);
  CHECK(idle.note == "its `when` never became true");
  CHECK(judged(check, {2, 0, 2, 9, 0, 2}).passed);  // ended before it was due once more
  const CheckResult open = judged(check, {2, 0, 2});
  CHECK_FALSE(open.passed);
  CHECK(open.note == "the run ended before within_s had passed");
}

TEST_CASE("settles wants the value in its band for good") {
  const ScenarioCheck check{.name = "n", .kind = CheckKind::settles, .signal = "x", .min = -1, .max = 1, .within_s = 2};
  const CheckResult soon = judged(check, {5, 2, 0.5, 0});
  CHECK(soon.passed);
  CHECK(soon.value == 1);
  CHECK_FALSE(judged(check, {5, 0, 0, 2, 0, 0}).passed);  // out once more, too late
  const CheckResult cut = judged(check, {5, 0});
  CHECK_FALSE(cut.passed);
  CHECK(cut.note == "the run ended before within_s had passed");
}

TEST_CASE("A condition that is wrong is refused with its place, all at once") {
  const double unused = 0;
  SignalTable signals;
  signals.add({"base.height_m", "m", ""}, &unused);
  const std::vector<ScenarioCheck> checks{{.name = "a", .that = "base.heigth_m > 0.6", .that_place = {3, 20}},
                                          {.name = "b", .that = "base.height_m > > 2", .that_place = {4, 20}},
                                          {.name = "c", .signal = "base.hight_m", .signal_place = {5, 20}}};
  try {
    const Checks refused(signals, checks, "s.json");
    FAIL("nothing was refused");
  } catch (const InputError& error) {
    REQUIRE(error.problems().size() == 3);
    CHECK(error.problems()[0].text() == "s.json:3:21: unknown signal 'base.heigth_m', did you mean 'base.height_m'?");
    CHECK(error.problems()[1].text() == "s.json:4:21: is not a condition: unexpected symbol near '>'");
    CHECK(error.problems()[2].text() == "s.json:5:20: unknown signal 'base.hight_m', did you mean 'base.height_m'?");
  }
}

TEST_CASE("A condition that goes wrong in the run fails every check, with the reason") {
  CHECK_FALSE(judged({.name = "n", .kind = CheckKind::never, .that = "x"}, {0, 1}).passed);
  const CheckResult number = judged({.name = "n", .kind = CheckKind::never, .that = "x + 1"}, {0, 1});
  CHECK(number.note == "not judged: 'x + 1' gives a number, wanted true or false");
}

TEST_CASE("A condition that goes wrong is told with its own check, and by its name with the others") {
  const double x = 1;
  SignalTable signals;
  signals.add({"x", "", ""}, &x);
  const std::vector<ScenarioCheck> all{{.name = "good", .kind = CheckKind::always, .that = "x > 0"},
                                       {.name = "odd", .kind = CheckKind::always, .that = "x + 1"},
                                       {.name = "low", .kind = CheckKind::always, .signal = "x", .max = 2}};
  Checks checks(signals, all, "s.json");
  checks.update(0, std::vector<double>{1});
  const std::vector<CheckResult> results = checks.results();
  REQUIRE(results.size() == 3);
  for (const CheckResult& one : results) CHECK_FALSE(one.passed);
  CHECK(results[0].note == "not judged: check 'odd' stopped all");
  CHECK(results[1].note == "not judged: 'x + 1' gives a number, wanted true or false");
  CHECK(results[2].note == "not judged: check 'odd' stopped all");
}

TEST_CASE("A condition cannot loop or reach for anything but signals and mathematics") {
  for (const char* text : {"(function() while true do end end)()", "string.rep('x', 1e9) == ''", "values[1] > 0"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(judged({.name = "n", .kind = CheckKind::always, .that = text}, {0}), InputError);
  }
}

TEST_CASE(
    "A check is lost from the tick on in which nothing can save it; at_end and eventually are not before the end") {
  const double unused = 0;
  SignalTable signals;
  signals.add({"x", "", ""}, &unused);
  const std::vector<double> values{0, 1, 0, 0, 2, 0};  // one a second
  const auto lost_at_s = [&](const ScenarioCheck& check) {
    Checks checks(signals, {check});
    for (std::size_t i = 0; i < values.size(); ++i) {
      checks.update(static_cast<double>(i), std::vector<double>{values[i]});
      if (checks.lost(0)) return static_cast<int>(i);
    }
    return -1;
  };
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::always, .signal = "x", .max = 1}) == 4);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::always, .signal = "x", .max = 1, .until_s = 3}) == -1);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::never, .signal = "x", .min = 1}) == 1);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::within, .that = "x > 1", .when = "x == 1", .within_s = 2}) == 4);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::within, .that = "x > 1", .when = "x == 1", .within_s = 1}) == 3);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::settles, .that = "x < 2", .within_s = 3}) == 4);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::settles, .that = "x < 2", .within_s = 4}) == -1);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::eventually, .signal = "x", .min = 9}) == -1);
  CHECK(lost_at_s({.name = "n", .kind = CheckKind::at_end, .signal = "x", .min = 9}) == -1);
}
