#include "engine/lockstep.h"

#include <algorithm>
#include <array>

#include <doctest/doctest.h>

#include "bench.h"

using namespace kadans;

namespace {

// Moves the hip in its first tick and notes the times at which it was called.
class MoveOnce final : public BehaviorHost {
 public:
  explicit MoveOnce(const Catalog& catalog) : hip_(catalog.setpoints.find("posture.hip.position_rad").value()) {}
  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override {
    times_ns.push_back(snapshot.time_ns);
    if (times_ns.size() > 1) return;
    commands.begin(snapshot.time_ns);
    (void)commands.add({.kind = CommandKind::set_point, .index = hip_, .value = 1.0, .duration_s = 0.5});
    (void)commands.commit();
  }
  std::vector<std::int64_t> times_ns;

 private:
  SetpointId hip_;
};

std::uint64_t hash_of_run() {
  bench::Robot robot;
  MoveOnce host(robot.catalog);
  BehaviorEngine behaviors(robot.sets, *robot.exchange, &host);
  Lockstep lockstep(robot.settings, robot.plant, robot.control, behaviors);
  StateHash hash;
  for (int i = 0; i < 300; ++i) {
    lockstep.step();
    hash.add(robot.control.row());
    robot.plant.hash(hash);
  }
  return hash.value();
}

}  // namespace

TEST_CASE("The behavior engine ticks every tenth control tick and sees the state of that tick") {
  bench::Robot robot;
  MoveOnce host(robot.catalog);
  BehaviorEngine behaviors(robot.sets, *robot.exchange, &host);
  Lockstep lockstep(robot.settings, robot.plant, robot.control, behaviors);
  for (int i = 0; i < 30; ++i) lockstep.step();
  CHECK(host.times_ns == std::vector<std::int64_t>{0, 10'000'000, 20'000'000});
  CHECK(robot.control.ticks() == 30);
  CHECK(lockstep.time_ns() == 30'000'000);
}

TEST_CASE("A behavior moves a joint through queue, control object and plant") {
  bench::Robot robot;
  MoveOnce host(robot.catalog);
  BehaviorEngine behaviors(robot.sets, *robot.exchange, &host);
  Lockstep lockstep(robot.settings, robot.plant, robot.control, behaviors);
  for (int i = 0; i < 2000; ++i) lockstep.step();
  CHECK(robot.position_rad(0) == doctest::Approx(1.0).epsilon(0.01));
  CHECK(robot.position_rad(1) == doctest::Approx(-0.2).epsilon(0.01));
}

TEST_CASE("The same run gives the same states, bit for bit") { CHECK(hash_of_run() == hash_of_run()); }

TEST_CASE("Periods are configuration: a loop at 100 Hz with behaviors at 10 Hz") {
  bench::Robot robot;
  MoveOnce host(robot.catalog);
  BehaviorEngine behaviors(robot.sets, *robot.exchange, &host);
  const EngineSettings slow{.control_period_s = 0.01, .behavior_period_s = 0.1};
  Lockstep lockstep(slow, robot.plant, robot.control, behaviors);
  for (int i = 0; i < 11; ++i) lockstep.step();
  CHECK(host.times_ns == std::vector<std::int64_t>{0, 100'000'000});
  CHECK(lockstep.time_ns() == 110'000'000);
}

TEST_CASE("A behavior period that is no whole multiple of the control period is refused") {
  bench::Robot robot;
  const EngineSettings odd{.control_period_s = 0.003, .behavior_period_s = 0.01};
  CHECK_THROWS_AS(Lockstep(odd, robot.plant, robot.control, robot.behaviors), std::invalid_argument);
}

namespace {

// Both robots' plants, in one time.
class TwoRobots final : public World {
 public:
  TwoRobots(bench::Robot& first, bench::Robot& second) : plants_{&first.plant, &second.plant} {}
  std::size_t robot_count() const noexcept override { return 2; }
  WorldRobot& robot(std::size_t number) noexcept override { return *plants_[number]; }
  void step(std::int64_t dt_ns) override {
    for (IdealWorld* plant : plants_) plant->step(dt_ns);
  }
  void hash(StateHash& hash) const noexcept override {
    for (const IdealWorld* plant : plants_) plant->hash(hash);
  }

 private:
  std::array<IdealWorld*, 2> plants_;
};

}  // namespace

TEST_CASE("Two robots run in one time, each with its own behaviors and behavior period, and as each would alone") {
  bench::Robot alone, first, second;
  MoveOnce alone_host(alone.catalog), second_host(second.catalog);
  BehaviorEngine alone_behaviors(alone.sets, *alone.exchange, &alone_host);
  BehaviorEngine behaviors(second.sets, *second.exchange, &second_host);
  const EngineSettings seldom{.behavior_period_s = 0.02};
  TwoRobots world(first, second);
  Lockstep lockstep(first.settings, world, first.control, first.behaviors);
  lockstep.add(seldom, second.control, behaviors);
  Lockstep only(seldom, alone.plant, alone.control, alone_behaviors);
  for (int i = 0; i < 300; ++i) {
    lockstep.step();
    only.step();
    REQUIRE(std::ranges::equal(second.control.row(), alone.control.row()));
  }
  CHECK(second_host.times_ns.size() == 15);
  CHECK(second.position_rad(0) > 0.1);
  CHECK(first.position_rad(0) == bench::Robot().position_rad(0));
  CHECK(first.control.ticks() == 300);
}

TEST_CASE("Robots of one world must have one control period") {
  bench::Robot first, second;
  TwoRobots world(first, second);
  Lockstep lockstep(first.settings, world, first.control, first.behaviors);
  CHECK_THROWS_WITH_AS(lockstep.add({.control_period_s = 0.002}, second.control, second.behaviors),
                       "the control period must be the same for all robots of a world", std::invalid_argument);
}
