#include "control/balance/step_plan.h"

#include <cmath>

#include <doctest/doctest.h>

namespace step_plan_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001;
using Phase = StepPlan::Phase;

// The left foot stands 0.06 m before the base, the right one 0.06 m behind it; xi is put over the middle of both.
struct Bench {
  StepPlan plan;
  StepPlan::Config config{.ahead_s = 0, .swing_s = 0.3};
  StepPlan::Sight sight;

  Bench() { stand({0.06, 0.1}, {-0.06, -0.1}); }
  void stand(const GroundPoint& left, const GroundPoint& right) {
    sight.over[0].foot_m = {left.x_m, left.y_m, -0.8};
    sight.over[1].foot_m = {right.x_m, right.y_m, -0.8};
    sight.force_N = {70, 70};
  }
  void xi(double x_m, double y_m) {
    for (DcmMeasure::OverFoot& over : sight.over) {
      over.dcm_x_m = x_m - over.foot_m[0];
      over.dcm_y_m = y_m - over.foot_m[1];
    }
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) plan.advance(config, sight, dt_s);
  }
  const StepPlan::State& state() const { return plan.state(); }
};

}  // namespace

TEST_CASE("StepPlan stands while xi stays over the soles") {
  Bench bench;
  bench.xi(0.06 + bench.config.front_m - 0.005, 0);
  bench.ticks(500);
  CHECK(bench.state().phase == Phase::stands);
  bench.xi(-0.06 - bench.config.back_m + 0.005, 0);
  bench.ticks(500);
  CHECK(bench.state().phase == Phase::stands);
  CHECK(bench.state().steps == 0);
}

TEST_CASE("StepPlan sends the foot behind past the one ahead when xi leaves forward, and the other way round") {
  Bench ahead;
  ahead.xi(0.06 + ahead.config.front_m + 0.005, 0);
  ahead.ticks(2);
  CHECK(ahead.state().phase == Phase::swings);
  CHECK(ahead.state().stance == 0);
  CHECK(ahead.state().from_m[0] == doctest::Approx(-0.12));
  Bench back;
  back.xi(-0.06 - back.config.back_m - 0.005, 0);
  back.ticks(2);
  CHECK(back.state().phase == Phase::swings);
  CHECK(back.state().stance == 1);
  CHECK(back.state().foothold.x_m < 0);
}

TEST_CASE("StepPlan looks ahead by xi's rate") {
  Bench bench;
  bench.config.ahead_s = 0.05;
  for (double x_m = 0; x_m < 0.06 + bench.config.front_m - 0.02; x_m += 0.001) {  // 1 m/s
    bench.xi(x_m, 0);
    bench.ticks(1);
  }
  CHECK(bench.state().phase == Phase::swings);
}

TEST_CASE("StepPlan puts the foot to where xi will be, a little further, and within reach") {
  Bench bench;
  bench.config.trust_per_s = 1000;
  bench.config.reach_m = 0.5;
  bench.xi(0.06 + 0.15, 0);
  bench.ticks(2);
  const double growth = std::exp(bench.sight.rate_per_s * (bench.config.swing_s - 0.001));
  const double toe_m = bench.config.sole.toe_m;
  const double xi_m = toe_m + (0.15 - toe_m) * growth;
  CHECK(bench.state().in_sole.x_m == toe_m);
  CHECK(bench.state().foothold.x_m ==
        doctest::Approx(xi_m - bench.config.sole.middle_m() + bench.config.extra_x_m).epsilon(0.01));
  CHECK(bench.state().foothold.y_m == doctest::Approx(-0.1 * growth - bench.config.extra_y_m).epsilon(0.01));
  bench.config.reach_m = 0.1;
  bench.ticks(1);
  CHECK(bench.state().foothold.x_m == 0.1);
}

TEST_CASE("StepPlan takes the foot along a path that ends in the foothold, and lands when it bears for touch_s") {
  Bench bench;
  bench.xi(0.06 + bench.config.front_m + 0.01, 0);
  bench.ticks(2);
  bench.sight.force_N = {140, 0};
  CHECK(bench.plan.other_foot(bench.config)[0] == doctest::Approx(-0.12).epsilon(0.01));
  bench.ticks(130);
  CHECK(bench.plan.other_foot(bench.config)[2] > 0.9 * bench.config.lift_m);
  bench.ticks(168);
  CHECK(bench.plan.other_foot(bench.config)[0] == doctest::Approx(bench.state().foothold.x_m));
  CHECK(bench.plan.other_foot(bench.config)[1] == doctest::Approx(bench.state().foothold.y_m));
  CHECK(bench.state().phase == Phase::swings);
  bench.sight.force_N = {100, 40};
  bench.ticks(2);
  bench.sight.force_N = {140, 0};
  bench.ticks(1);
  CHECK(bench.state().phase == Phase::swings);
  bench.sight.force_N = {100, 40};
  bench.ticks(2);
  CHECK(bench.state().phase == Phase::swings);
  bench.ticks(1);
  CHECK(bench.state().phase == Phase::bears);
}

TEST_CASE("StepPlan takes no force for a landing in the first half of a swing, and waits no longer than it must") {
  Bench bench;
  bench.xi(0.06 + bench.config.front_m + 0.01, 0);
  bench.ticks(100);
  CHECK(bench.state().phase == Phase::swings);
  bench.sight.force_N = {140, 0};
  bench.ticks(500);
  CHECK(bench.state().phase == Phase::bears);
}

TEST_CASE("StepPlan shares the load by xi between the feet as they landed, and steps again when xi leaves them") {
  Bench bench;
  bench.xi(0.06 + bench.config.front_m + 0.01, 0);
  bench.ticks(200);
  bench.stand({-0.1, 0.1}, {0.2, -0.2});
  bench.config.trust_per_s = 1000;
  bench.config.again_m = 0.05;
  bench.xi(0.05, -0.05);
  bench.ticks(400);
  CHECK(bench.state().phase == Phase::bears);
  CHECK(bench.state().goal.x_m == doctest::Approx(0.15).epsilon(0.01));
  CHECK(bench.state().right_share == doctest::Approx(0.5).epsilon(0.2));
  CHECK(bench.state().steps == 1);
  bench.xi(0.45, -0.2);
  bench.ticks(20);
  CHECK(bench.state().phase == Phase::swings);
  CHECK(bench.state().stance == 1);
  CHECK(bench.state().steps == 2);
}

}  // namespace step_plan_test
