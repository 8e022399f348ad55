// The state of the control engine as a whole: another engine that gets it goes on bit for bit.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/tick/engine_states.h"
#include "kadans/testing/allocation_count.h"

namespace engine_state_test {

using namespace kadans;

namespace {

// A robot that always does the same in the same tick: its samples follow from the tick alone.
struct Played final : Plant {
  void read(SensorFrame& sensors) noexcept override {
    sensors.joint_count = 2;
    for (std::uint32_t i = 0; i < 2; ++i) {
      sensors.joints[i].position_rad = 0.3 * std::sin(0.01 * static_cast<double>(tick + 70 * i));
      sensors.joints[i].motor_position_rad = sensors.joints[i].position_rad;
      sensors.joints[i].sequence = static_cast<std::uint32_t>(tick + 1);
    }
    sensors.imu.angular_velocity_rad_s = {0.1, 0.02 * std::cos(0.1 * static_cast<double>(tick)), 0};
    sensors.imu.acceleration_m_s2 = {0, 0.3, 9.8};
    sensors.imu.sequence = static_cast<std::uint32_t>(tick + 1);
  }
  void write(const ActuationFrame&) noexcept override {}
  std::uint64_t tick = 0;
};

// With drives, so that a switch of control sets fades.
std::vector<std::unique_ptr<ControlObject>> objects_with_drives(Catalog& catalog, const RobotModel& model) {
  catalog.drives.assign(2, DriveLaw{.effort_max_Nm = 20});
  return bench::posture(catalog, model);
}

struct Engine : bench::Robot {
  Played played;
  Catalog own;
  std::vector<std::unique_ptr<ControlObject>> own_objects = objects_with_drives(own, model);
  ControlSets own_sets{own, std::move(own_objects)};
  ControlEngine engine{settings, played, estimator, safety, own_sets, own, *exchange};
  CommandSender sender{exchange->commands};

  std::int64_t now_ns() const { return static_cast<std::int64_t>(engine.ticks()) * 1'000'000; }
  void send(const std::vector<Command>& commands) {
    sender.begin(now_ns());
    for (const Command& command : commands) REQUIRE(sender.add(command));
    REQUIRE(sender.commit() > 0);
  }
  SetpointId setpoint(const char* name) const { return own.setpoints.find(name).value(); }
  // Each tick by its number.
  void tick() {
    const std::uint64_t number = engine.ticks();
    played.tick = number;
    if (number == 50)
      send({{.kind = CommandKind::trapezoid,
             .index = setpoint("posture.hip.position_rad"),
             .value = 0.5,
             .duration_s = 0.4,
             .velocity = 5,
             .acceleration = 50},
            {.kind = CommandKind::via_point,
             .index = setpoint("posture.knee.position_rad"),
             .value = -0.4,
             .duration_s = 0.2}});
    if (number == 60)
      send({{.kind = CommandKind::set_parameter,
             .index = own.parameters.find("posture.hip.kp_Nm_per_rad").value(),
             .value = 55},
            {.kind = CommandKind::arm, .index = 1, .count = 2, .duration_s = 1},
            {.kind = CommandKind::condition,
             .count = static_cast<std::uint32_t>(ConditionKind::above),
             .time_ns = signal_key("joint.hip.position_rad"),
             .value = 0.25},
            {.kind = CommandKind::switch_set, .index = 1}});
    if (number == 300) send({{.kind = CommandKind::set_point, .index = 9999, .value = 1}});
    exchange->heartbeat.publish(number < 420 ? now_ns() : 420'000'000);
    engine.tick(now_ns(), 0.001);
  }
  std::vector<std::byte> save() {
    StateBytes measuring(StateBytes::Levels::low);
    engine.pass_state(measuring);
    std::vector<std::byte> bytes(measuring.size());
    StateBytes saving = StateBytes::saving(bytes, StateBytes::Levels::low);
    engine.pass_state(saving);
    CHECK(saving.ok());
    bytes.resize(saving.size());
    return bytes;
  }
};

bool same_bits(std::span<const double> a, std::span<const double> b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

}  // namespace

TEST_CASE(
    "Another engine goes on bit for bit from a saved state: through motions, armed commands, switches and faults") {
  for (std::uint64_t at = 1; at < 700; at += 19) {
    CAPTURE(at);
    Engine first, second;
    while (first.engine.ticks() < at) first.tick();
    const std::vector<std::byte> state = first.save();
    REQUIRE(second.engine.restore(at, state));
    CHECK(second.save() == state);
    second.sender.follow(first.engine.inbox().last_taken(), SIZE_MAX);
    while (first.engine.ticks() < 900) {
      first.tick();
      second.tick();
      REQUIRE(first.save() == second.save());
      const auto actuation = [](const Engine& e) { return e.engine.actuation().joints[0].effort_Nm; };
      REQUIRE(actuation(first) == actuation(second));
    }
    CHECK(same_bits(first.engine.row(), second.engine.row()));
    CHECK(first.engine.state().status.safety.level >= SafetyLevel::hold);  // the heartbeat ended
  }
}

TEST_CASE("A state that is too short, too long or wrong is refused, and no bytes lead out of the engine's memory") {
  Engine engine;
  while (engine.engine.ticks() < 130) engine.tick();
  const std::vector<std::byte> state = engine.save();
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, state.size() / 2, state.size() - 1}) {
    Engine other;
    CHECK_FALSE(other.engine.restore(130, std::span(state).first(size)));
  }
  std::vector<std::byte> longer = state;
  longer.push_back(std::byte{0});
  Engine other;
  CHECK_FALSE(other.engine.restore(130, longer));
  std::mt19937 draw(7);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> wrong = state;
    for (int k = 0; k < 1 + i / 10; ++k) wrong[draw() % wrong.size()] = static_cast<std::byte>(draw());
    Engine damaged;
    if (!damaged.engine.restore(130, wrong)) {
      ++refused;
      continue;
    }
    for (int k = 0; k < 20; ++k) damaged.tick();
  }
  CHECK(refused > 20);
}

TEST_CASE("The part of a state is told by its name") {
  Engine engine;
  while (engine.engine.ticks() < 130) engine.tick();
  const std::size_t size = engine.save().size();
  CHECK(engine.engine.part_of_state(0) == "the control engine itself");
  CHECK(engine.engine.part_of_state(size - 1) == "control object spare");
  CHECK(engine.engine.part_of_state(size) == "its end");
}

TEST_CASE("A state is saved in its tick without allocating, and one that waits is not overwritten") {
  Engine engine;
  EngineStates states(engine.engine, {}, 100);
  while (engine.engine.ticks() < 130) engine.tick();
  const testing::AllocationCount heap;
  states.save_if_due(99);
  EngineStates::Saved saved;
  const bool none = states.take(saved);
  states.save_if_due(100);
  const bool there = states.take(saved);
  states.save_if_due(200);
  (void)states.take(saved);
  const long allocations = heap.count();
  CHECK_FALSE(none);
  CHECK(there);
  CHECK(saved.tick == 100);
  CHECK(allocations == 0);
  states.done();
  CHECK_FALSE(states.take(saved));
}

}  // namespace engine_state_test
