// Motions that the engine plans, on an object that can be led: every kind is held against the same table.
#include "engine/motion/setpoint_motions.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/tick/command_inbox.h"
#include "engine/transaction.h"
#include "kadans/testing/allocation_count.h"

namespace setpoint_motions_test {

using namespace kadans;

namespace {

constexpr double dt_s = 0.001;

// One set-point, which goes where it is led.
class Led final : public ControlObject {
 public:
  void declare(Declaration& declaration) override {
    declaration.setpoint({.name = "hip.position_rad", .unit = "rad", .min = -2, .max = 2});
  }
  void start(const ControlInput&) noexcept override { reference = {}; }
  void step(const ControlInput&, ActuationFrame&) noexcept override { now = reference; }
  bool setpoint_state(std::uint32_t, SetpointState& state) const noexcept override { return state = reference, true; }
  void follow(std::uint32_t, const SetpointState& state) noexcept override { reference = state; }

  SetpointState reference, now;
};

// The same, but it plans the way to a plain set-point itself.
class Planner final : public ControlObject {
 public:
  void declare(Declaration& declaration) override {
    declaration.setpoint({.name = "hip.position_rad", .unit = "rad", .min = -2, .max = 2, .own_motion = true});
  }
  void start(const ControlInput&) noexcept override {}
  void step(const ControlInput&, ActuationFrame&) noexcept override {}
  void set_point(std::uint32_t, double value, double duration_s) noexcept override { asked = {value, duration_s, 0}; }
  void cancel_motion(std::uint32_t) noexcept override { ++cancelled; }
  bool setpoint_state(std::uint32_t, SetpointState& state) const noexcept override { return state = told, true; }
  void follow(std::uint32_t, const SetpointState& state) noexcept override { told = state; }

  SetpointState asked, told;  // asked: value and duration
  int cancelled = 0;
};

// Two such objects, each in a set of its own, behind a queue.
struct Stand {
  Stand() {
    catalog.model = &model;
    std::vector<std::unique_ptr<ControlObject>> objects;
    for (const char* name : {"led", "spare"}) {
      auto object = std::make_unique<Led>();
      Declaration declaration(name, static_cast<std::uint32_t>(objects.size()), catalog.parameters, catalog.setpoints,
                              catalog.signals);
      object->declare(declaration);
      if (led == nullptr) led = object.get();
      objects.push_back(std::move(object));
    }
    catalog.objects = {{.name = "led", .type = "test", .joints = {0}},
                       {.name = "spare", .type = "test", .joints = {0}}};
    catalog.sets = {{"led", {0}}, {"spare", {1}}};
    sets = std::make_unique<ControlSets>(catalog, std::move(objects));
    inbox = std::make_unique<CommandInbox>(*queue, catalog, *sets, 256, 1'000'000'000);
    actuation.joint_count = 2;
    tick();
  }
  void send(const std::vector<Command>& commands) {
    CommandSender sender(*queue);
    sender.begin(time_ns);
    for (const Command& command : commands) REQUIRE(sender.add(command));
    REQUIRE(sender.commit() > 0);
  }
  void tick() {
    const ControlInput input{joints, snapshot.status, actuation, time_ns, dt_s};
    inbox->apply(0, input, safety);
    inbox->motions().step(dt_s);
    sets->step(0, input, actuation);
    sets->fill(snapshot);
    inbox->motions().fill(snapshot);
    time_ns += 1'000'000;
  }
  double remaining_s() const { return snapshot.objects[0].motion_remaining_s; }

  RobotModel model = bench::robot();
  Catalog catalog;
  Led* led = nullptr;
  Safety safety{bench::safety_settings(), model};
  std::unique_ptr<CommandQueue> queue = std::make_unique<CommandQueue>();
  std::unique_ptr<ControlSets> sets;
  std::unique_ptr<CommandInbox> inbox;
  JointStates joints;
  ActuationFrame actuation;
  Snapshot snapshot;
  std::int64_t time_ns = 0;
};

Command trapezoid(double value, double velocity, double acceleration, double duration_s) {
  return {.kind = CommandKind::trapezoid,
          .value = value,
          .duration_s = duration_s,
          .velocity = velocity,
          .acceleration = acceleration};
}
Command via(std::uint32_t number, double value, double duration_s) {
  return {.kind = CommandKind::via_point, .count = number, .value = value, .duration_s = duration_s};
}

// From rest at 0 to rest at 1.
struct Kind {
  const char* name;
  std::vector<Command> commands;
  double duration_s, peak_per_s, acceleration_per_s2;
};
const Kind kinds[] = {
    {"minimum jerk", {{.kind = CommandKind::set_point, .value = 1, .duration_s = 1}}, 1, 1.875, 5.78},
    {"trapezoid within limits", {trapezoid(1, 2, 10, 0)}, 0.71, 2, 10},
    {"trapezoid in a time", {trapezoid(1, 4, 5.5, 1)}, 1, 1.328, 5.5},
    {"triangle", {trapezoid(1, 100, 4, 0)}, 1.01, 1.98, 4},
    {"spline", {via(0, 0.5, 0.5), via(1, 1, 0.5)}, 1, 1.5, 6},
    {"spline of one point", {via(0, 1, 1)}, 1, 1.5, 6},
    {"spline of uneven points",
     {via(0, 0.2, 0.4), via(1, 0.6, 0.3), via(2, 0.9, 0.2), via(3, 1, 0.3)},
     1.2,
     1.64,
     7.46},
};

struct Course {
  double peak_per_s = 0, acceleration_per_s2 = 0;  // as they are, from tick to tick
  double told_wrong = 0;                           // velocity told, against the way it went
};

Course run(Stand& stand, int ticks) {
  Course course;
  for (int i = 0; i < ticks; ++i) {
    const SetpointState before = stand.led->now;
    stand.tick();
    const SetpointState& now = stand.led->now;
    const double went_per_s = (now.value - before.value) / dt_s;
    course.peak_per_s = std::max(course.peak_per_s, std::abs(went_per_s));
    course.acceleration_per_s2 = std::max(course.acceleration_per_s2, std::abs(now.velocity - before.velocity) / dt_s);
    course.told_wrong = std::max(course.told_wrong, std::abs(went_per_s - 0.5 * (now.velocity + before.velocity)));
  }
  return course;
}

}  // namespace

TEST_CASE("every kind of motion ends at rest at its target in its time, with the peaks that its kind has") {
  for (const Kind& kind : kinds) {
    CAPTURE(kind.name);
    Stand stand;
    stand.send(kind.commands);
    stand.tick();
    CHECK(stand.remaining_s() == doctest::Approx(kind.duration_s - dt_s).epsilon(0.003));
    const Course course = run(stand, static_cast<int>(std::lround(kind.duration_s / dt_s)) + 1);
    CHECK(stand.remaining_s() == 0);
    CHECK(stand.led->now.value == doctest::Approx(1).epsilon(1e-12));
    CHECK(stand.led->now.velocity == 0);
    CHECK(course.peak_per_s == doctest::Approx(kind.peak_per_s).epsilon(0.01));
    CHECK(course.acceleration_per_s2 == doctest::Approx(kind.acceleration_per_s2).epsilon(0.02));
    CHECK(course.told_wrong < 0.002);
    run(stand, 10);
    CHECK(stand.led->now.value == doctest::Approx(1).epsilon(1e-12));
  }
}

TEST_CASE("a motion cancelled on its way comes to rest close by, without a jump in position or velocity") {
  for (const Kind& kind : kinds) {
    CAPTURE(kind.name);
    Stand stand;
    stand.send(kind.commands);
    run(stand, static_cast<int>(std::lround(kind.duration_s / dt_s / 2)));
    const SetpointState before = stand.led->now;
    REQUIRE(before.velocity > 1);
    stand.send({{.kind = CommandKind::cancel_motion}});
    const Course course = run(stand, 100);
    CHECK(course.peak_per_s < before.velocity * 1.02 + 0.02);
    CHECK(course.acceleration_per_s2 < 60);  // of the stop itself: 2 m/s to 0 in 0.1 s
    CHECK(course.told_wrong < 0.02);
    CHECK(stand.led->now.velocity == 0);
    CHECK(stand.led->now.value == doctest::Approx(before.value + 0.05 * before.velocity).epsilon(0.02));
    CHECK(stand.remaining_s() == 0);
  }
}

TEST_CASE("every kind of motion takes over every other one without a jump") {
  for (const Kind& first : kinds) {
    for (const Kind& second : kinds) {
      CAPTURE(first.name);
      CAPTURE(second.name);
      Stand stand;
      stand.send({first.commands});
      run(stand, 300);
      const double velocity = stand.led->now.velocity;
      stand.send({second.commands});
      run(stand, 1);
      CHECK(std::abs(stand.led->now.velocity - velocity) < 0.05);
      const Course course = run(stand, 2000);
      CHECK(course.told_wrong < 0.02);
      CHECK(stand.led->now.value == doctest::Approx(1).epsilon(1e-12));
      CHECK(stand.remaining_s() == 0);
    }
  }
}

TEST_CASE("an object that plans its way itself gets plain set-points and cancellations, trapezoids lead it") {
  Catalog catalog;
  const RobotModel model = bench::robot();
  catalog.model = &model;
  std::vector<std::unique_ptr<ControlObject>> objects;
  objects.push_back(std::make_unique<Planner>());
  auto& planner = static_cast<Planner&>(*objects.front());
  Declaration declaration("planner", 0, catalog.parameters, catalog.setpoints, catalog.signals);
  planner.declare(declaration);
  catalog.objects = {{.name = "planner", .type = "test", .joints = {0}}};
  catalog.sets = {{"planner", {0}}};
  ControlSets sets(catalog, std::move(objects));
  SetpointMotions motions(catalog, sets);
  const JointStates joints;
  const RobotStatus status;
  ActuationFrame actuation;
  const auto tick = [&] {
    motions.step(dt_s);
    sets.step(0, {joints, status, actuation, 0, dt_s}, actuation);
  };
  tick();
  motions.move(0, 0.5, 2);
  tick();
  CHECK(planner.asked.value == 0.5);
  CHECK(planner.asked.velocity == 2);
  CHECK(planner.told.value == 0);
  motions.begin(trapezoid(1, 2, 10, 0));
  tick();
  CHECK(planner.told.value > 0);
  const double led_to = planner.told.value;
  motions.cancel(0);
  tick();
  CHECK(planner.cancelled == 1);
  CHECK(planner.told.value == led_to);
}

TEST_CASE("a plain set-point without a duration acts in its tick, and ends a motion") {
  Stand stand;
  stand.send({{.kind = CommandKind::set_point, .value = 1, .duration_s = 1}});
  run(stand, 300);
  stand.send({{.kind = CommandKind::set_point, .value = -0.5}});
  stand.tick();
  CHECK(stand.led->now.value == -0.5);
  CHECK(stand.led->now.velocity == 0);
  CHECK(stand.remaining_s() == 0);
  run(stand, 100);
  CHECK(stand.led->now.value == -0.5);
}

TEST_CASE("a trapezoid follows a target that moves, within its limits") {
  Stand stand;
  Course all;
  double farthest = 0;
  for (int i = 0; i < 300; ++i) {  // a behavior's ticks
    const double time_s = 0.01 * i;
    stand.send({trapezoid(0.5 * std::sin(2 * time_s), 1.5, 8, 0)});
    const Course course = run(stand, 10);
    all.peak_per_s = std::max(all.peak_per_s, course.peak_per_s);
    all.acceleration_per_s2 = std::max(all.acceleration_per_s2, course.acceleration_per_s2);
    if (i > 50) farthest = std::max(farthest, std::abs(0.5 * std::sin(2 * time_s) - stand.led->now.value));
  }
  CHECK(all.peak_per_s < 1.5 + 1e-6);
  CHECK(all.acceleration_per_s2 < 8.01);
  CHECK(farthest < 0.15);
}

TEST_CASE("a motion of an object that leaves the active set is dropped: back again it stays where it starts") {
  Stand stand;
  stand.send({trapezoid(1, 2, 10, 0)});
  run(stand, 200);
  stand.send({{.kind = CommandKind::switch_set, .index = 1}});
  run(stand, 1);
  CHECK(std::isnan(stand.snapshot.setpoints[0].value));
  stand.send({{.kind = CommandKind::switch_set, .index = 0}});
  run(stand, 500);
  CHECK(stand.led->now.value == 0);
  CHECK(stand.snapshot.setpoints[0].value == 0);
}

TEST_CASE("a motion of an object that starts anew on its way is dropped: it stays where it starts") {
  Stand stand;
  stand.send({trapezoid(1, 2, 10, 0)});
  run(stand, 200);
  stand.led->reference = {.value = 0.05};
  run(stand, 500);
  CHECK(stand.led->now.value == 0.05);
  CHECK(stand.remaining_s() == 0);
}

TEST_CASE("a motion that begins in the tick in which its object starts anew is led, whatever moved the object before") {
  for (const Kind& before : kinds) {
    for (const Kind& kind : kinds) {
      CAPTURE(before.name);
      CAPTURE(kind.name);
      Stand stand;
      stand.send(before.commands);
      run(stand, 200);
      // Away and back in one tick: the object starts at 0.
      stand.send({{.kind = CommandKind::switch_set, .index = 1}});
      std::vector<Command> back{{.kind = CommandKind::switch_set, .index = 0}};
      back.insert(back.end(), kind.commands.begin(), kind.commands.end());
      stand.send(back);
      run(stand, 1);
      CHECK(stand.remaining_s() > 0.5);
      run(stand, 1400);
      CHECK(stand.led->now.value == doctest::Approx(1));
    }
  }
}

TEST_CASE("the snapshot tells where a set-point is and how fast it moves") {
  Stand stand;
  stand.send({trapezoid(1, 2, 10, 0)});
  run(stand, 350);
  CHECK(stand.snapshot.setpoints[0].value == stand.led->now.value);
  CHECK(stand.snapshot.setpoints[0].velocity == doctest::Approx(2));
}

TEST_CASE("a motion whose numbers are not acceptable is refused whole") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const Command& bad :
       {trapezoid(2.5, 1, 1, 1), trapezoid(nan, 1, 1, 1), trapezoid(1, 0, 1, 1), trapezoid(1, 1, -1, 1),
        trapezoid(1, inf, 1, 1), trapezoid(1, 1, nan, 1), trapezoid(1, 1, 1, -1), trapezoid(1, 1, 1, nan), via(0, 1, 0),
        via(0, nan, 1), via(0, 2.5, 1), via(CubicSpline::points_max, 1, 1)}) {
    Stand stand;
    stand.send({bad});
    run(stand, 5);
    CHECK(stand.inbox->state().refused == 1);
    CHECK(stand.led->now.value == 0);
  }
}

TEST_CASE("planning and following motions allocates nothing") {
  Stand stand;
  for (const Kind& kind : kinds) stand.send(kind.commands);
  const testing::AllocationCount heap;
  for (int i = 0; i < 50; ++i) stand.tick();
  const long allocations = heap.count();
  CHECK(allocations == 0);
}

TEST_CASE("a spline swings beyond its points where they turn, and says how far") {
  CubicSpline spline;
  spline.begin(0, 0);
  REQUIRE(spline.add(1, 0.5));
  REQUIRE(spline.add(0.9, 0.5));
  spline.plan();
  double highest = 0;
  for (int i = 0; i <= 1000; ++i) highest = std::max(highest, spline.at(0.001 * i).value);
  CHECK(highest > 1.01);
  CHECK(spline.range().highest == doctest::Approx(highest).epsilon(1e-5));
  CHECK(spline.range().lowest == 0);
  CHECK_FALSE(spline.add(1, 0));
  for (std::size_t i = spline.size(); i < CubicSpline::points_max; ++i) REQUIRE(spline.add(1, 0.1));
  CHECK_FALSE(spline.add(1, 0.1));
}

}  // namespace setpoint_motions_test
