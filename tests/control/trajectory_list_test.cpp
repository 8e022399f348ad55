#include "control/joint/trajectory_list.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "object_bench.h"

namespace trajectory_list_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

ObjectBench tuned(std::unique_ptr<ControlObject> (*make)(const ObjectSetup&) = make_trajectory_list) {
  ObjectBench bench(make);
  bench.set("hip.kp_Nm_per_rad", 100);
  bench.set("hip.kd_Nms_per_rad", 4);
  bench.start();
  bench.compute();
  return bench;
}

TrajectoryList& list(ObjectBench& bench) { return dynamic_cast<TrajectoryList&>(*bench.object); }

double sine_rad(double t_s) { return 0.25 * (1 - std::cos(2 * std::numbers::pi * t_s)); }

// A high level: keeps the list filled with points of a sine, 10 ms apart, 30 ms ahead.
class SineList final : public TrajectoryList {
 public:
  using TrajectoryList::TrajectoryList;
  void update(const Snapshot& snapshot) override {
    const double until_s = 1e-9 * static_cast<double>(snapshot.time_ns) + 0.03;
    while (written_s_ + 0.005 < until_s) {
      written_s_ += 0.01;
      REQUIRE(append(0, {.position_rad = sine_rad(written_s_), .duration_s = 0.01, .more = true}));
    }
  }

 private:
  double written_s_ = 0;
};
std::unique_ptr<ControlObject> make_sine(const ObjectSetup& setup) { return std::make_unique<SineList>(setup); }

}  // namespace

TEST_CASE("TrajectoryList passes the points of a list in their times and rests at the last") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 0.3, 0.2);
  bench.set_point("hip.position_rad", 0.5, 0.2);
  bench.set_point("hip.position_rad", 0.1, 0.4);
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.8));
  bench.run(200);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.3));
  CHECK(bench.signal("hip.reference_velocity_rad_s") == doctest::Approx(1.25));  // passed on the way
  CHECK(bench.signal("hip.waiting") == 1);
  bench.run(200);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.5));
  CHECK(std::abs(bench.signal("hip.reference_velocity_rad_s")) < 1e-9);  // turns there
  bench.run(400);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.1));
  CHECK(bench.motion_remaining_s() == 0);
  CHECK(bench.signal("hip.underruns") == 0);
  CHECK(bench.computed.joints[0].mode == ActuationMode::effort);
}

TEST_CASE("TrajectoryList's reference stays between its points") {
  ObjectBench bench = tuned();
  const double points[] = {0.1, 0.1, 0.9, 1.0, 1.0, 0.2};
  for (const double point : points) bench.set_point("hip.position_rad", point, 0.1);
  double from = 0;
  for (const double to : points) {
    for (int i = 0; i < 100; ++i) {
      bench.tick();
      const double reference = bench.signal("hip.reference_rad");
      REQUIRE(reference >= std::min(from, to) - 1e-9);
      REQUIRE(reference <= std::max(from, to) + 1e-9);
    }
    from = to;
  }
}

TEST_CASE("TrajectoryList without append replaces what is left of the list, no duration is at once") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 0.3, 0.2);
  bench.set_point("hip.position_rad", 0.5, 0.2);
  bench.run(100);
  const double there = bench.signal("hip.reference_rad");
  bench.set("hip.append", 0);
  bench.set_point("hip.position_rad", -0.2, 0.3);
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.3));
  bench.run(1);
  CHECK(bench.signal("hip.reference_rad") > there);  // goes on with the velocity that it had
  bench.run(299);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(-0.2));
  bench.set_point("hip.position_rad", 0.4, 0);
  bench.run(1);
  CHECK(bench.signal("hip.reference_rad") == 0.4);
}

TEST_CASE("TrajectoryList lets a point that comes late still change the velocity at the one before") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 0.3, 0.2);
  bench.run(150);
  bench.set_point("hip.position_rad", 0.6, 0.2);
  bench.run(50);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.3));
  CHECK(bench.signal("hip.reference_velocity_rad_s") > 0.5);
}

TEST_CASE("TrajectoryList follows what its high level writes, and fetches it without waiting") {
  ObjectBench bench = tuned(make_sine);
  Snapshot snapshot;
  double worst_rad = 0;
  for (int i = 0; i < 2000; ++i) {
    snapshot.time_ns = i * 1'000'000LL;
    if (i % 10 == 0) bench.object->update(snapshot);
    bench.tick();
    worst_rad = std::max(worst_rad, std::abs(bench.signal("hip.reference_rad") - sine_rad((i + 1) * 0.001)));
  }
  CHECK(worst_rad < 0.001);
  CHECK(bench.signal("hip.underruns") == 0);
}

TEST_CASE("TrajectoryList whose high level falls silent comes to rest, says so, and goes on when it returns") {
  ObjectBench bench = tuned(make_sine);
  Snapshot snapshot;
  bench.object->update(snapshot);
  bench.run(400);
  CHECK(bench.signal("hip.underrun") == 1);
  CHECK(bench.signal("hip.underruns") == 1);
  CHECK(bench.signal("hip.reference_velocity_rad_s") == 0);
  snapshot.time_ns = 50'000'000;
  bench.object->update(snapshot);
  bench.run(5);
  CHECK(bench.signal("hip.underrun") == 0);
}

TEST_CASE("TrajectoryList underrun at a point that is passed fast stops beyond it, smoothly") {
  ObjectBench bench = tuned();
  REQUIRE(list(bench).append(0, {.position_rad = 0.2, .velocity_rad_s = 2, .duration_s = 0.1, .more = true}));
  bench.run(100);
  CHECK(bench.signal("hip.reference_velocity_rad_s") == doctest::Approx(2.0));
  CHECK(bench.signal("hip.underrun") == 1);
  bench.run(101);
  CHECK(bench.signal("hip.reference_rad") == doctest::Approx(0.3));
  CHECK(bench.signal("hip.reference_velocity_rad_s") == 0);
}

TEST_CASE("TrajectoryList refuses what it cannot follow and counts what does not fit") {
  ObjectBench bench = tuned();
  CHECK_FALSE(list(bench).append(0, {.position_rad = 2.1, .duration_s = 0.1}));
  CHECK_FALSE(list(bench).append(0, {.position_rad = NAN, .duration_s = 0.1}));
  CHECK_FALSE(list(bench).append(0, {.position_rad = 0, .velocity_rad_s = INFINITY, .duration_s = 0.1}));
  CHECK_FALSE(list(bench).append(0, {.position_rad = 0, .duration_s = 0}));
  for (std::size_t i = 0; i < TrajectoryLaw::capacity; ++i) {
    REQUIRE(list(bench).append(0, {.position_rad = 0.1, .duration_s = 0.1}));
    bench.set_point("hip.position_rad", 0.1, 0.1);
  }
  CHECK_FALSE(list(bench).append(0, {.position_rad = 0.1, .duration_s = 0.1}));
  bench.set_point("hip.position_rad", 0.1, 0.1);
  bench.run(1);
  CHECK(bench.signal("hip.dropped") == 1);
  CHECK(bench.signal("hip.waiting") == 2 * TrajectoryLaw::capacity - 1);
  bench.cancel("hip.position_rad");
  bench.run(150);
  CHECK(bench.motion_remaining_s() == 0);
}

}  // namespace trajectory_list_test
