// What moving the whole body costs. In the control thread: a tick of TULip's walk. In the behavior thread: the high
// level of TULip's object while it sinks, shifts its weight and leans, each call by itself, and what it takes to say
// that a target can be reached.
#include <algorithm>
#include <string>

#include "bench/report.h"
#include "body_rig.h"
#include "walk_rig.h"

namespace kadans::bench {
namespace {

constexpr int behavior_ticks = 600, walk_ticks = 6000;
constexpr double behavior_period_us = 10'000;

void bench_walk(Report& report) {
  WalkRig rig;
  std::vector<double> each_us;
  for (int i = 0; i < walk_ticks; ++i) {
    rig.feel();
    const double began = now_ns();
    rig.step();
    each_us.push_back(1e-3 * (now_ns() - began));
  }
  report.add("walk.steps", "walk, steps made", rig.steps(), "");
  report.add("walk.tick_us", "walk, a tick, median", median(each_us), "us");
}

}  // namespace

void bench_body(Report& report) {
  bench_walk(report);
  BodyRig rig;
  std::vector<double> each_us;
  double most = 0;
  for (int i = 0; i < behavior_ticks; ++i) {
    rig.low_level();
    const double began = now_ns();
    rig.high_level();
    each_us.push_back(1e-3 * (now_ns() - began));
    most = std::max(most, rig.signal("iterations"));
  }
  const double worst_us = *std::max_element(each_us.begin(), each_us.end()), median_us = median(each_us);
  report.add("body.median_us", "whole body, high level, median", median_us, "us");
  report.add("body.worst_us", "whole body, high level, worst", worst_us, "us");
  report.add("body.period_share", "whole body, median, share of the behavior period", median_us / behavior_period_us,
             "");
  report.add("body.iterations", "whole body, most iterations of its program", most, "");
  report.add("body.failures", "whole body, programs without a solution", rig.signal("failures"), "");
  report.add("body.foresee_us", "whole body, whether two targets can be reached",
             1e-3 * time_ns([&] { rig.foresee(); }, 1, 100), "us");
}

}  // namespace kadans::bench
