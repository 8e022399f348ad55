#include "engine/tick/armed_transactions.h"

#include <array>
#include <initializer_list>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/refusal_text.h"
#include "engine/transaction.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;

namespace {

// Joints that are where the test says.
class Posed final : public Plant {
 public:
  void read(SensorFrame& sensors) noexcept override {
    sensors.joint_count = 2;
    sensors.imu.sequence = ++sequence_;
    sensors.imu.acceleration_m_s2 = {0, 0, 9.81 + 1e-6 * (sequence_ % 2)};
    for (std::uint32_t i = 0; i < 2; ++i) {
      sensors.joints[i] = {};
      sensors.joints[i].position_rad = sensors.joints[i].motor_position_rad = position_rad[i];
      sensors.joints[i].sequence = sequence_;
    }
  }
  void write(const ActuationFrame& actuation) noexcept override { written = actuation; }

  std::array<double, 2> position_rad{};
  ActuationFrame written;

 private:
  std::uint32_t sequence_ = 0;
};

struct Stand : bench::Robot {
  Posed posed;
  Catalog own;
  std::vector<std::unique_ptr<ControlObject>> own_objects = bench::posture(own, model);
  ControlSets own_sets{own, std::move(own_objects)};
  ControlEngine engine{settings, posed, estimator, safety, own_sets, own, *exchange};
  CommandSender sender{exchange->commands};
  std::int64_t time_ns = 0;
  bool beats = true;
  ParameterId kp = own.parameters.find("posture.knee.kp_Nm_per_rad").value();

  Stand() { ticks(2); }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      if (beats) exchange->heartbeat.publish(time_ns);
      engine.tick(time_ns, 0.001);
      time_ns += 1'000'000;
    }
  }
  std::uint32_t send(std::initializer_list<Command> commands) {
    sender.begin(time_ns);
    for (const Command& command : commands) REQUIRE(sender.add(command));
    return sender.commit();
  }
  Command set_kp(double value) const { return {.kind = CommandKind::set_parameter, .index = kp, .value = value}; }
  Command set_hip(double value, double duration_s = 0) const {
    const SetpointId id = own.setpoints.find("posture.hip.position_rad").value();
    return {.kind = CommandKind::set_point, .index = id, .value = value, .duration_s = duration_s};
  }
  Command hip(ConditionKind kind, double value) const {
    return {.kind = CommandKind::condition,
            .count = static_cast<std::uint32_t>(kind),
            .time_ns = signal_key("joint.hip.position_rad"),
            .value = value};
  }
  static Command after(double seconds) {
    return {
        .kind = CommandKind::condition, .count = static_cast<std::uint32_t>(ConditionKind::after), .value = seconds};
  }
  static Command arm(std::uint32_t conditions, std::uint32_t commands, double within_s = 1, std::uint32_t options = 0) {
    return {.kind = CommandKind::arm,
            .index = conditions,
            .count = conditions + commands,
            .sequence = options,
            .duration_s = within_s};
  }
  double value() const { return own.parameters.get(kp); }
  Snapshot seen() const { return exchange->snapshot.newest(1); }
  ArmedStatus status(std::uint32_t sequence, std::uint16_t which = 0) const {
    const Snapshot snapshot = seen();
    for (const ArmedStatus& one : snapshot.armed) {
      if (one.sequence == sequence && one.which == which) return one;
    }
    return {};
  }
  Refusal refusal() const {
    const Snapshot snapshot = seen();
    return snapshot.refusals[(snapshot.transactions_refused - 1) % refusals_shown];
  }
};

}  // namespace

TEST_CASE("An armed transaction acts in the tick of its condition as one that arrives in this tick") {
  Stand armed, plain;
  const std::uint32_t number =
      armed.send({Stand::arm(1, 2), armed.hip(ConditionKind::above, 0.003), armed.set_kp(70), armed.set_hip(0.5)});
  for (Stand* stand : {&armed, &plain}) stand->ticks(20);
  CHECK(armed.value() == 40);
  CHECK(armed.status(number).state == ArmedState::waits);
  for (Stand* stand : {&armed, &plain}) stand->posed.position_rad[0] = 0.004;
  (void)plain.send({plain.set_kp(70), plain.set_hip(0.5)});
  const std::uint64_t tick = armed.engine.state().tick + 1;
  for (int i = 0; i < 5; ++i) {
    for (Stand* stand : {&armed, &plain}) stand->ticks(1);
    CAPTURE(i);
    CHECK(armed.value() == 70);
    for (std::size_t joint = 0; joint < 2; ++joint)
      CHECK(armed.posed.written.joints[joint].effort_Nm == plain.posed.written.joints[joint].effort_Nm);
  }
  CHECK(armed.status(number).state == ArmedState::done);
  CHECK(armed.status(number).fired == 1);
  CHECK(armed.status(number).fired_tick == tick);
}

TEST_CASE("It is carried out once, or each time that its conditions become true") {
  for (const bool every_time : {false, true}) {
    CAPTURE(every_time);
    Stand stand;
    const std::uint32_t number = stand.send({Stand::arm(1, 1, 1, every_time ? arm_every_time : 0),
                                             stand.hip(ConditionKind::below, -0.003), stand.set_kp(70)});
    for (int i = 0; i < 3; ++i) {
      stand.posed.position_rad[0] = -0.004;
      stand.ticks(4);
      stand.posed.position_rad[0] = 0;
      stand.ticks(4);
    }
    CHECK(stand.status(number).fired == (every_time ? 3 : 1));
    CHECK(stand.status(number).state == (every_time ? ArmedState::waits : ArmedState::done));
  }
}

TEST_CASE("All conditions must be true in the same tick, or one suffices") {
  for (const bool any : {false, true}) {
    CAPTURE(any);
    Stand stand;
    (void)stand.send({Stand::arm(2, 1, 1, any ? arm_any : 0), stand.hip(ConditionKind::above, 0.003),
                      Stand::after(0.01), stand.set_kp(70)});
    stand.posed.position_rad[0] = 0.004;
    stand.ticks(5);
    CHECK(stand.value() == (any ? 70 : 40));
    stand.posed.position_rad[0] = 0;
    stand.ticks(20);
    CHECK(stand.value() == (any ? 70 : 40));
    stand.posed.position_rad[0] = 0.004;
    stand.ticks(1);
    CHECK(stand.value() == 70);
  }
}

TEST_CASE("Time counts from the tick in which it was armed, and what waits too long expires") {
  Stand stand;
  const std::uint32_t timed = stand.send({Stand::arm(1, 1), Stand::after(0.01), stand.set_kp(70)});
  const std::uint32_t late =
      stand.send({Stand::arm(1, 1, 0.02), stand.hip(ConditionKind::above, 0.003), stand.set_kp(90)});
  stand.ticks(10);
  CHECK(stand.value() == 40);
  stand.ticks(1);
  CHECK(stand.value() == 70);
  CHECK(stand.status(timed).state == ArmedState::done);
  stand.ticks(10);
  CHECK(stand.status(late).state == ArmedState::waits);
  stand.ticks(1);
  CHECK(stand.status(late).state == ArmedState::expired);
  stand.posed.position_rad[0] = 0.004;
  stand.ticks(3);
  CHECK(stand.value() == 70);
}

TEST_CASE("The end of a motion is a condition") {
  Stand stand;
  const Command arrived{.kind = CommandKind::condition,
                        .index = stand.set_hip(0).index,
                        .count = static_cast<std::uint32_t>(ConditionKind::arrived)};
  (void)stand.send({stand.set_hip(0.2, 0.05), Stand::arm(1, 1), arrived, stand.set_kp(70)});
  int ticks = 0;
  for (; stand.value() == 40 && ticks < 100; ++ticks) stand.ticks(1);
  CHECK(ticks >= 50);
  CHECK(ticks <= 52);
}

TEST_CASE("It can be taken back, one by one, also in the tick of its condition") {
  Stand stand;
  const std::uint32_t number = stand.send({Stand::arm(1, 1), stand.hip(ConditionKind::above, 0.003), stand.set_kp(70),
                                           Stand::arm(1, 1), stand.hip(ConditionKind::above, 0.003), stand.set_kp(90)});
  stand.ticks(2);
  stand.posed.position_rad[0] = 0.004;
  (void)stand.send({Command{.kind = CommandKind::disarm, .index = 1, .sequence = number}});
  stand.ticks(1);
  CHECK(stand.value() == 70);
  CHECK(stand.status(number, 0).state == ArmedState::done);
  CHECK(stand.status(number, 1).state == ArmedState::taken_back);
}

TEST_CASE("An arm that is torn, asks for what cannot wait, or is one too many refuses its whole transaction") {
  Stand stand;
  const Command condition = stand.hip(ConditionKind::above, 0.003), good = stand.set_kp(70);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Command unknown{.kind = CommandKind::condition, .time_ns = 99};
  const Command odd{.kind = CommandKind::condition, .count = 77, .time_ns = condition.time_ns};
  const Command clear{.kind = CommandKind::clear_faults}, header{.kind = CommandKind::transaction};
  struct Case {
    std::vector<Command> commands;
    RefusalReason reason;
  };
  constexpr auto malformed = RefusalReason::malformed, out_of_range = RefusalReason::out_of_range,
                 motion = RefusalReason::motion, armed_full = RefusalReason::armed_full;
  const Case cases[] = {
      {{Stand::arm(1, 5), condition, good}, malformed},
      {{Stand::arm(0, 1), good}, malformed},
      {{Stand::arm(1, 0), condition}, malformed},
      {{Stand::arm(5, 1), condition, condition, condition, condition, condition, good}, malformed},
      {{Stand::arm(1, 1), good, good}, malformed},
      {{Stand::arm(1, 1), condition, condition}, malformed},
      {{Stand::arm(1, 1), condition, clear}, malformed},
      {{Stand::arm(1, 1), condition, header}, malformed},
      {{Stand::arm(1, 1), condition, Stand::arm(1, 1)}, malformed},
      {{condition}, malformed},
      {{Stand::arm(1, 1), odd, good}, malformed},
      {{Stand::arm(1, 1), unknown, good}, RefusalReason::unknown},
      {{Stand::arm(1, 1), stand.hip(ConditionKind::above, nan), good}, out_of_range},
      {{Stand::arm(1, 1), Stand::after(-1), good}, out_of_range},
      {{Stand::arm(1, 1), condition, stand.set_kp(-1)}, out_of_range},
      {{Stand::arm(1, 1, nan), condition, good}, motion},
      {{Stand::arm(1, 1, 1e9), condition, good}, motion},
  };
  for (const Case& one : cases) {
    stand.sender.begin(stand.time_ns);
    REQUIRE(stand.sender.add(stand.set_kp(55)));
    for (const Command& command : one.commands) REQUIRE(stand.sender.add(command));
    const std::uint32_t number = stand.sender.commit();
    stand.ticks(1);
    CAPTURE(number);
    CHECK(stand.refusal().sequence == number);
    CHECK(stand.refusal().reason == one.reason);
    CHECK(stand.status(number).state == ArmedState::none);
  }
  CHECK(stand.value() == 40);
  for (std::size_t i = 0; i < max_armed; ++i) (void)stand.send({Stand::arm(1, 1), condition, good});
  stand.ticks(1);
  CHECK(stand.refusal().reason != armed_full);
  (void)stand.send({Stand::arm(1, 1), condition, good});
  stand.ticks(1);
  CHECK(refusal_text(stand.refusal(), stand.own) == "as many transactions as can wait are armed already");
}

TEST_CASE("What the robot's state forbids when the condition comes is refused then, and told") {
  Stand stand;
  const std::uint32_t number =
      stand.send({Stand::arm(1, 1, 100), stand.hip(ConditionKind::above, 0.003), stand.set_kp(70)});
  stand.ticks(1);
  stand.beats = false;
  for (int i = 0; i < 1000 && stand.engine.state().status.safety.level < SafetyLevel::hold; ++i) stand.ticks(1);
  CHECK(stand.status(number).state == ArmedState::waits);
  stand.posed.position_rad[0] = 0.004;
  stand.ticks(1);
  CHECK(stand.status(number).state == ArmedState::refused);
  CHECK(stand.status(number).reason == RefusalReason::robot_held);
  CHECK(stand.refusal().sequence == number);
  CHECK(stand.value() == 40);
}

TEST_CASE("The emergency stop takes back what is armed") {
  Stand stand;
  const std::uint32_t number =
      stand.send({Stand::arm(1, 1, 100), stand.hip(ConditionKind::above, 0.003), stand.set_kp(70)});
  stand.ticks(1);
  stand.safety.emergency_stop().ask({});
  stand.ticks(1);
  CHECK(stand.status(number).state == ArmedState::taken_back);
}

TEST_CASE("Armed transactions take no memory while they wait and when they act") {
  Stand stand;
  for (std::size_t i = 0; i < max_armed; ++i)
    (void)stand.send({Stand::arm(1, 2, 1, arm_every_time), stand.hip(ConditionKind::above, 0.003), stand.set_kp(70),
                      stand.set_hip(0.2, 0.1)});
  const testing::AllocationCount heap;
  stand.ticks(5);
  stand.posed.position_rad[0] = 0.004;
  stand.ticks(5);
  CHECK(heap.count() == 0);
  CHECK(stand.value() == 70);
}

TEST_CASE("Ten thousand arms and cancels leave no place taken and no memory, and the last one acts") {
  Stand stand;
  const testing::AllocationCount heap;
  const Command condition = stand.hip(ConditionKind::above, 0.003);
  for (int i = 0; i < 10'000; ++i) {
    const std::uint32_t number = stand.send({Stand::arm(1, 1), condition, stand.set_kp(90)});
    (void)stand.send({Command{.kind = CommandKind::disarm, .index = 0, .sequence = number},
                      Command{.kind = CommandKind::disarm, .index = 7, .sequence = number + 9}});
    if (i % 8 == 7) stand.ticks(1);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(stand.seen().transactions_refused == 0);
  const std::uint32_t last = stand.send({Stand::arm(1, 1), condition, stand.set_kp(70)});
  stand.posed.position_rad[0] = 0.004;
  stand.ticks(1);
  CHECK(stand.status(last).state == ArmedState::done);
  CHECK(stand.value() == 70);
}

TEST_CASE(
    "It acts as a command does on an object whose set is not active: that object starts from where the joint is") {
  Stand armed, plain;
  const auto spare_hip = [](const Stand& stand) {
    const SetpointId id = stand.own.setpoints.find("spare.hip.position_rad").value();
    return Command{.kind = CommandKind::set_point, .index = id, .value = 1, .duration_s = 0.5};
  };
  const std::uint32_t number = armed.send({Stand::arm(1, 1), Stand::after(0), spare_hip(armed)});
  (void)plain.send({spare_hip(plain)});
  for (Stand* stand : {&armed, &plain}) {
    stand->ticks(5);
    (void)stand->send({{.kind = CommandKind::switch_set, .index = 1}});
    stand->ticks(20);
  }
  CHECK(armed.status(number).state == ArmedState::done);
  for (std::size_t joint = 0; joint < 2; ++joint)
    CHECK(armed.posed.written.joints[joint].effort_Nm == plain.posed.written.joints[joint].effort_Nm);
}

TEST_CASE("From the tick of the condition to the torque are two ticks: one that computes, one that writes") {
  Stand armed, untouched;
  (void)armed.send({Stand::arm(1, 1), armed.hip(ConditionKind::above, 0.003), armed.set_kp(90)});
  for (Stand* stand : {&armed, &untouched}) stand->ticks(20);
  for (Stand* stand : {&armed, &untouched}) stand->posed.position_rad[0] = stand->posed.position_rad[1] = 0.004;
  const auto differ = [&] {
    return armed.posed.written.joints[1].effort_Nm != untouched.posed.written.joints[1].effort_Nm;
  };
  for (Stand* stand : {&armed, &untouched}) stand->ticks(1);  // measured, and computed with the new gain
  CHECK(armed.value() == 90);
  CHECK_FALSE(differ());
  for (Stand* stand : {&armed, &untouched}) stand->ticks(1);
  CHECK(differ());
}
