#include "engine/tick/control_engine.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "bench.h"
#include "kadans/control/state_bytes.h"

using namespace kadans;

namespace {

// Notes the order in which the engine uses the plant and what it writes.
class Recorder final : public Plant {
 public:
  void read(SensorFrame& sensors) noexcept override {
    calls[count++ % calls.size()] = 'r';
    sensors = next;
    sensors.joint_count = 2;
    for (std::uint32_t i = 0; i < 2; ++i) sensors.joints[i].sequence = ++sequence_;
  }
  void write(const ActuationFrame& actuation) noexcept override {
    calls[count++ % calls.size()] = 'w';
    written = actuation;
  }

  std::array<char, 64> calls{};
  std::size_t count = 0;
  SensorFrame next;
  ActuationFrame written;

 private:
  std::uint32_t sequence_ = 0;
};

struct Engine : bench::Robot {
  Recorder recorder;
  Catalog own;
  std::vector<std::unique_ptr<ControlObject>> own_objects = bench::posture(own, model);
  ControlSets own_sets{own, std::move(own_objects)};
  ControlEngine engine{settings, recorder, estimator, safety, own_sets, own, *exchange};
  std::int64_t time_ns = 0;

  void tick() {
    exchange->heartbeat.publish(time_ns);
    engine.tick(time_ns, 0.001);
    time_ns += 1'000'000;
  }
  void command(const Command& command) {
    CommandSender sender(exchange->commands);
    sender.begin(time_ns);
    REQUIRE(sender.add(command));
    REQUIRE(sender.commit() > 0);
  }
  Command move_hip(double value) const {
    const SetpointId id = own.setpoints.find("posture.hip.position_rad").value();
    return {.kind = CommandKind::set_point, .index = id, .value = value};
  }
};

// As hexadecimal digits, what an object would go on from.
std::string state_of(ControlObject& object) {
  std::vector<std::byte> bytes(4096);
  StateBytes save = StateBytes::saving(bytes, StateBytes::Levels::low);
  object.pass_state(save);
  std::string text;
  for (std::size_t i = 0; i < save.size(); ++i) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", std::to_integer<unsigned>(bytes[i]));
    text += digits;
  }
  return text;
}

}  // namespace

TEST_CASE("A tick samples, then writes what the last tick computed") {
  Engine bench;
  bench.tick();
  CHECK(bench.recorder.calls[0] == 'r');
  CHECK(bench.recorder.calls[1] == 'w');
  CHECK(bench.recorder.count == 2);
  CHECK(bench.recorder.written.joints[0].mode == ActuationMode::off);  // nothing was computed before
  bench.command(bench.move_hip(0.5));
  bench.tick();  // computes 40 Nm/rad x 0.5 rad ...
  CHECK(bench.recorder.written.joints[0].effort_Nm == doctest::Approx(0.0));
  bench.tick();  // ... and writes it in the next tick
  CHECK(bench.recorder.written.joints[0].effort_Nm == doctest::Approx(20.0));
}

TEST_CASE("A command takes effect in the tick after it was sent") {
  Engine bench;
  bench.tick();
  bench.command(bench.move_hip(0.5));
  CHECK(bench.exchange->snapshot.newest(1).transactions_applied == 0);
  bench.tick();
  CHECK(bench.exchange->snapshot.newest(1).transactions_applied == 1);
}

TEST_CASE("The snapshot carries tick, time, joints and the active set") {
  Engine bench;
  bench.recorder.next.joints[1].position_rad = 0.7;
  bench.tick();
  bench.tick();
  const Snapshot snapshot = bench.exchange->snapshot.newest(1);
  CHECK(snapshot.tick == 1);
  CHECK(snapshot.time_ns == 1'000'000);
  CHECK(snapshot.joints.joints[1].position_rad == doctest::Approx(0.7));
  CHECK(snapshot.control_sets == 0b1);
  CHECK(snapshot.objects[0].active);
  CHECK_FALSE(snapshot.objects[1].active);
}

TEST_CASE("An actuation that is not finite is never written: the joint damps and the fault is kept") {
  Engine bench;
  bench.tick();
  bench.tick();
  bench.recorder.next.joints[0].position_rad = std::numeric_limits<double>::quiet_NaN();
  for (int i = 0; i < 5; ++i) {
    bench.tick();
    REQUIRE(std::isfinite(bench.recorder.written.joints[0].effort_Nm));
  }
  CHECK(bench.engine.state().status.safety.level >= SafetyLevel::damp);
  CHECK(bench.engine.state().status.safety.first_fault.joint == 0);
}

TEST_CASE("The state in which the tick of a fault found the objects is kept for the flight recorder") {
  Engine bench;
  double hip_rad = 0.1;
  std::string found;
  const auto tick = [&] {  // each tick changes the object's state
    bench.command(bench.move_hip(hip_rad += 0.01));
    found = state_of(bench.own_sets.object(0));
    bench.tick();
    REQUIRE(state_of(bench.own_sets.object(0)) != found);
  };
  for (int i = 0; i < 3; ++i) tick();
  CHECK(bench.engine.fault_state().facts().empty());
  bench.recorder.next.joints[1].position_rad = std::numeric_limits<double>::quiet_NaN();
  while (bench.engine.state().status.safety.level < SafetyLevel::hold && bench.engine.ticks() < 20) tick();
  const TextMap facts{{"tick", std::to_string(bench.engine.ticks() - 1)},
                      {"object posture", found},
                      {"object spare", state_of(bench.own_sets.object(1))}};
  CHECK(bench.engine.fault_state().facts() == facts);
  tick();
  CHECK(bench.engine.fault_state().facts() == facts);
}

TEST_CASE("Switching sets by command makes the other object compute") {
  Engine bench;
  bench.tick();
  bench.command({.kind = CommandKind::switch_set, .index = 1});
  bench.tick();
  CHECK(bench.exchange->snapshot.newest(1).control_sets == 0b10);
  CHECK(bench.exchange->snapshot.newest(1).objects[1].active);
}
