// What each kind of metric makes of a run.
#include "scenario/judge/metrics.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace kadans;

namespace {

MetricConfig metric(MetricKind kind, const char* signal, const char* that = "") {
  return {.name = "m", .place = {}, .kind = kind, .signal = signal, .that = that};
}

// Half a second of a signal that rises from 0 to 4, then falls to 3.
double value_of(const MetricConfig& config, double broken_at_s = -1) {
  SignalTable table;
  double x = 0;
  table.add({.name = "x", .unit = "", .doc = ""}, &x);
  Metrics metrics(table, {config}, "plan.json");
  for (const double value : {0.0, 1.0, 2.0, 3.0, 4.0, 3.0}) {
    static const double period_s = 0.1;
    const double time_s = period_s * (value == 3.0 && x == 4.0 ? 5 : value);
    x = time_s == broken_at_s ? std::numeric_limits<double>::quiet_NaN() : value;
    metrics.tick(time_s, std::vector<double>{x});
    x = value;
  }
  return metrics.values().at(0).value;
}

}  // namespace

TEST_CASE("Each kind of metric has its value") {
  CHECK(value_of(metric(MetricKind::max, "x")) == 4);
  CHECK(value_of(metric(MetricKind::min, "x")) == 0);
  CHECK(value_of(metric(MetricKind::mean, "x")) == doctest::Approx(13.0 / 6));
  CHECK(value_of(metric(MetricKind::rms, "x")) == doctest::Approx(std::sqrt(39.0 / 6)));
  CHECK(value_of(metric(MetricKind::end, "x")) == 3);
  CHECK(value_of(metric(MetricKind::end, "", "x > 3")) == 0);
  CHECK(value_of(metric(MetricKind::share, "", "x >= 3")) == 0.5);
  CHECK(value_of(metric(MetricKind::first_time, "", "x > 1")) == doctest::Approx(0.2));
  CHECK(value_of(metric(MetricKind::since, "", "x >= 3")) == doctest::Approx(0.3));
}

TEST_CASE("What never came about has no value, and a value that is no number is not passed over") {
  CHECK(std::isnan(value_of(metric(MetricKind::first_time, "", "x > 9"))));
  CHECK(std::isnan(value_of(metric(MetricKind::since, "", "x > 3"))));  // not at the end
  CHECK(std::isnan(value_of(metric(MetricKind::mean, "x"), 0.2)));
  MetricConfig late = metric(MetricKind::max, "x");
  late.from_s = 9;
  CHECK(std::isnan(value_of(late)));
  late.from_s = 0;
  late.until_s = 0.25;
  CHECK(value_of(late) == 2);
}

TEST_CASE("A metric of an unknown signal is refused at its place") {
  SignalTable table;
  double x = 0;
  table.add({.name = "base.height_m", .unit = "m", .doc = ""}, &x);
  MetricConfig wrong = metric(MetricKind::max, "base.hight_m");
  wrong.signal_place = {3, 4};
  CHECK_THROWS_WITH_AS(Metrics(table, {wrong}, "plan.json"),
                       "plan.json:3:4: unknown signal 'base.hight_m', did you mean 'base.height_m'?", InputError);
}

TEST_CASE("A metric of a number made of signals takes what its expression gives, and what is no number is no value") {
  const auto number = [](MetricKind kind, const char* value) {
    MetricConfig config = metric(kind, "");
    config.value = value;
    return value_of(config);
  };
  CHECK(number(MetricKind::max, "(x - 2)^2") == 4);
  CHECK(number(MetricKind::end, "sqrt(x + 6) + last.x") == 7);
  CHECK(number(MetricKind::mean, "2 * x") == doctest::Approx(13.0 / 3));
  CHECK(std::isnan(number(MetricKind::max, "x > 1")));
  CHECK(std::isnan(value_of(metric(MetricKind::end, "", "x + 1"))));
}
