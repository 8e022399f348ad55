// The kit's search for the switching that excites a joint most: it finds a pair that runs away, and calls no sound pair
// bad.
#include <cmath>
#include <sstream>
#include <vector>

#include "control/made_objects.h"
#include "kadans/testing/doctest.h"

namespace switching_stability_test {

using namespace kadans;
using namespace kadans::testing;

namespace {

std::unique_ptr<JointBench> bench() {
  auto bench = std::make_unique<JointBench>(
      JointBenchConfig{
          .plant = {.inertia_kg_m2 = 0.1, .viscous_Nms_per_rad = 0.3, .gravity_Nm = 7, .position_rad = 0.8}},
      std::vector<BenchObject>{{"pid", make_joint_pid}, {"same", make_joint_pid}, {"free", make_gravity_compensation}});
  for (const char* object : {"pid", "same"}) {
    bench->set(std::string(object) + ".joint.kp_Nm_per_rad", 150);
    bench->set(std::string(object) + ".joint.kd_Nms_per_rad", 6);
    bench->set(std::string(object) + ".joint.ki_Nm_per_rads", 50);
  }
  return bench;
}

constexpr SwitchingSearch quick{.offset_rad = 0.8, .duration_s = 4, .periods = 6, .refinements = 6};

}  // namespace

TEST_CASE("Two like laws take turns as one of them alone moves") {
  const SwitchingStability found = switching_stability(bench, "pid", "same", quick);
  INFO(found);
  CHECK(found <= StabilityLimits{.energy_ratio = 1.05, .error_ratio = 1.05});
  CHECK(found.first_alone.rms_error_rad == found.second_alone.rms_error_rad);
  CHECK(found.most_growth.growth < 1.1);
  CHECK(found.motions == 6 * 3 * 2 + 2 + 6);
}

TEST_CASE("A stiff law and one that lets go, each stable, run away together: the search finds it, a dwell calms them") {
  const SwitchingStability fast = switching_stability(bench, "pid", "free", quick);
  INFO(fast);
  CHECK(!(fast <= StabilityLimits{}));
  CHECK(fast.energy_ratio > 5);  // of that of rare switches
  SwitchingSearch slow = quick;
  slow.dwell_s = 1;
  const SwitchingStability calm = switching_stability(bench, "pid", "free", slow);
  INFO(calm);
  CHECK(calm.energy_ratio < 0.1 * fast.energy_ratio);
}

TEST_CASE("The same seed finds the same, another one looks elsewhere, and no stay is shorter than the dwell") {
  SwitchingSearch search = quick;
  search.dwell_s = 0.2;
  const SwitchingStability found = switching_stability(bench, "pid", "free", search);
  CHECK(switching_stability(bench, "pid", "free", search).most_energy.energy_J == found.most_energy.energy_J);
  for (const SwitchedMotion& motion : {found.most_energy, found.most_error, found.most_growth}) {
    CHECK(motion.pattern.share * motion.pattern.period_s >= 0.2 - 1e-9);
    CHECK((1 - motion.pattern.share) * motion.pattern.period_s >= 0.2 - 1e-9);
  }
  const SwitchedMotion again = switched_motion(bench, "pid", "free", found.most_energy.pattern, search);
  CHECK(again.energy_J == found.most_energy.energy_J);
}

TEST_CASE("What is found says the worst switching in words, and what is not finite is the worst") {
  std::ostringstream out;
  out << switching_stability(bench, "pid", "same",
                             {.offset_rad = 0.8, .duration_s = 2, .periods = 1, .refinements = 0});
  CHECK(out.str().find("switching between pid and same, 8 motions") == 0);
  CHECK(out.str().find("most energy (") != std::string::npos);
  SwitchingStability broken;
  broken.error_ratio = broken.most_error.rms_error_rad = std::nan("");
  CHECK(!(broken <= StabilityLimits{}));
}

}  // namespace switching_stability_test
