// Several control sets at once: those that share no joint go on side by side.
#include <doctest/doctest.h>

#include "kadans/control/control_sets.h"
#include "kadans/testing/allocation_count.h"
#include "made_objects.h"
#include "two_joint_robot.h"

namespace sets_together_test {

using namespace kadans;

namespace {

enum Set : std::uint32_t { body, legs, arm, stiff_arm };
constexpr double dt_s = 0.001;

// Three motors that move as a sine says, whatever they are told; PID laws with an integral, so that they remember.
struct Bench {
  RobotModel model;
  Catalog catalog;
  std::unique_ptr<ControlSets> sets;
  JointStates joints;
  RobotStatus status;
  ActuationFrame computed;
  std::uint64_t tick = 0;

  explicit Bench(SetMask initial = set_bit(body)) {
    model.links.resize(4);
    model.joints = {test_joint("hip", 20), test_joint("knee", 20), test_joint("arm", 10)};
    catalog.model = &model;
    catalog.sets = {{"body", {0}}, {"legs", {1}}, {"arm", {2}}, {"stiff_arm", {3}}};
    catalog.initial_sets = initial;
    catalog.unheld.assign(3, {.stiffness_Nm_per_rad = 50, .damping_Nms_per_rad = 2});
    for (const Joint& joint : model.joints) catalog.drives.push_back({.effort_max_Nm = joint.effort_max_Nm});
    joints.count = computed.joint_count = 3;
    make({{"body", {0, 1, 2}}, {"legs", {0, 1}}, {"arm", {2}}, {"stiff_arm", {2}}});
  }
  void make(const std::vector<std::pair<std::string, std::vector<std::size_t>>>& wanted) {
    std::vector<std::unique_ptr<ControlObject>> objects;
    for (const auto& [name, driven] : wanted) {
      objects.push_back(make_joint_pid(ObjectSetup{model, driven}));
      Declaration declaration(name, static_cast<std::uint32_t>(objects.size() - 1), catalog.parameters,
                              catalog.setpoints, catalog.signals);
      objects.back()->declare(declaration);
      catalog.objects.push_back({.name = name, .joints = driven});
    }
    for (const std::string& name : catalog.parameters.names()) {
      const double value = name.ends_with("kp_Nm_per_rad")     ? 100
                           : name.ends_with("ki_Nm_per_rads")  ? 50
                           : name.ends_with("integral_max_Nm") ? 5
                                                               : -1;
      if (value > 0) (void)catalog.parameters.set(*catalog.parameters.find(name), value);
    }
    sets = std::make_unique<ControlSets>(catalog, std::move(objects));
  }
  void step() {
    const double time_s = dt_s * static_cast<double>(tick);
    for (std::size_t i = 0; i < 3; ++i) {
      const double rate_rad_s = 3 + static_cast<double>(i);
      joints.joints[i] = {.position_rad = 0.2 * std::sin(rate_rad_s * time_s),
                          .velocity_rad_s = 0.2 * rate_rad_s * std::cos(rate_rad_s * time_s)};
    }
    const ActuationFrame written = computed;
    sets->step(tick++, {joints, status, written, 0, dt_s}, computed);
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) step();
  }
  double effort_Nm(std::size_t joint) const { return computed.joints[joint].effort_Nm; }
  std::string refused(SetMask initial) const {
    try {
      const Bench other(initial);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  }
};

}  // namespace

TEST_CASE("A set that comes in takes the place of exactly those that it shares a joint with") {
  Bench bench;
  bench.step();
  const auto after = [&](Set set) {
    bench.sets->switch_to(set);
    bench.step();
    return bench.sets->active();
  };
  CHECK(after(legs) == set_bit(legs));
  CHECK(after(arm) == (set_bit(legs) | set_bit(arm)));
  CHECK(after(stiff_arm) == (set_bit(legs) | set_bit(stiff_arm)));
  CHECK(after(stiff_arm) == (set_bit(legs) | set_bit(stiff_arm)));
  CHECK(after(body) == set_bit(body));
  Snapshot snapshot;
  bench.sets->fill(snapshot);
  CHECK(snapshot.control_sets == set_bit(body));
  CHECK(snapshot.objects[0].active);
  CHECK_FALSE(snapshot.objects[1].active);
}

TEST_CASE("A set notices nothing of switches that do not touch it, not even while it fades in itself") {
  Bench calm, busy;
  std::vector<double> expected, seen;
  const auto record = [](Bench& bench, std::vector<double>& to) {
    bench.step();
    to.push_back(bench.effort_Nm(0));
    to.push_back(bench.effort_Nm(1));
  };
  for (int tick = 0; tick < 600; ++tick) {
    if (tick == 100) calm.sets->switch_to(legs), busy.sets->switch_to(legs);
    if (tick >= 100 && tick % 37 == 0) busy.sets->switch_to(tick % 2 == 0 ? arm : stiff_arm);
    record(calm, expected);
    record(busy, seen);
  }
  CHECK(seen == expected);  // bit for bit
}

TEST_CASE("With sets beside it a switch makes no step either") {
  Bench bench(set_bit(legs) | set_bit(arm));
  bench.run(300);
  for (const Set set : {stiff_arm, body, legs, arm}) {
    const ActuationFrame before = bench.computed;
    bench.sets->switch_to(set);
    bench.step();
    for (std::size_t joint = 0; joint < 3; ++joint) {
      // Without the fade the arm would step by 5 Nm of the integral; the joints move on meanwhile.
      CHECK(std::abs(bench.effort_Nm(joint) - before.joints[joint].effort_Nm) < 0.02 * 10);
    }
    bench.run(50);
  }
}

TEST_CASE("A joint that no active set holds is drawn back to where it was let go") {
  Bench bench;
  bench.run(100);
  const double before_Nm = bench.effort_Nm(2);
  bench.sets->switch_to(legs);
  bench.step();
  const double there_rad = bench.joints.joints[2].position_rad;
  CHECK(bench.effort_Nm(2) == doctest::Approx(before_Nm).epsilon(0.05));
  bench.run(250);  // the fade is over
  const JointState& now = bench.joints.joints[2];
  CHECK(bench.effort_Nm(2) == doctest::Approx(50 * (there_rad - now.position_rad) - 2 * now.velocity_rad_s));
  bench.sets->switch_to(body);  // and legs again: from the new place
  bench.run(100);
  bench.sets->switch_to(legs);
  bench.step();
  const double new_rad = bench.joints.joints[2].position_rad;
  CHECK(new_rad != doctest::Approx(there_rad).epsilon(0.01));
  bench.run(250);
  CHECK(bench.effort_Nm(2) == doctest::Approx(50 * (new_rad - bench.joints.joints[2].position_rad) -
                                              2 * bench.joints.joints[2].velocity_rad_s));
}

TEST_CASE("Sets that are active first share no joint") {
  const Bench bench;
  CHECK(bench.refused(set_bit(legs) | set_bit(stiff_arm)) == "accepted");
  CHECK(bench.refused(set_bit(body) | set_bit(arm)) == "the initial control sets share a joint");
  CHECK(bench.refused(0) == "there is no initial control set");
  CHECK(bench.refused(16) == "there is no initial control set");
}

TEST_CASE("Switching among several sets takes no memory") {
  Bench bench;
  bench.step();
  const testing::AllocationCount heap;
  for (const Set set : {legs, arm, stiff_arm, body}) {
    bench.sets->switch_to(set);
    bench.run(3);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

}  // namespace sets_together_test
