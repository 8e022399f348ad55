// switch_dwell_s: what happens with a switch of control sets that comes too early, whoever sends it.
#include <algorithm>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/refusal_text.h"
#include "engine/transaction.h"
#include "kadans/testing/allocation_count.h"

namespace switch_dwell_test {

using namespace kadans;

namespace {

enum Set : std::uint32_t { posture, spare };
constexpr int dwell_ticks = 50;

std::vector<std::unique_ptr<ControlObject>> dwelling(Catalog& catalog, const RobotModel& model, bool object) {
  auto objects = bench::posture(catalog, model);
  (object ? catalog.objects[spare].switch_dwell_s : catalog.sets[spare].switch_dwell_s) = 0.001 * dwell_ticks;
  catalog.sets.push_back({"both_names", {spare}});  // the same object in another set
  return objects;
}

// The two motors under the control engine; set "spare", or its object, demands 50 ms between two switches.
struct Stand : bench::Robot {
  Catalog own;
  std::vector<std::unique_ptr<ControlObject>> own_objects;
  ControlSets own_sets;
  ControlEngine engine;
  CommandSender sender{exchange->commands};
  std::int64_t time_ns = 0;

  explicit Stand(bool object = false)
      : own_objects(dwelling(own, model, object)),
        own_sets(own, std::move(own_objects)),
        engine(settings, plant, estimator, safety, own_sets, own, *exchange) {
    ticks(2);
  }
  void ticks(int count) {
    for (int i = 0; i < count; ++i) {
      exchange->heartbeat.publish(time_ns);
      engine.tick(time_ns, 0.001);
      plant.step(1'000'000);
      time_ns += 1'000'000;
    }
  }
  std::uint32_t send(std::initializer_list<Command> commands) {
    sender.begin(time_ns);
    for (const Command& command : commands) REQUIRE(sender.add(command));
    return sender.commit();
  }
  // Sends it and lets a tick pass. "" when it was taken.
  std::string refusal(std::initializer_list<Command> commands) {
    const std::uint32_t number = send(commands);
    ticks(1);
    const Snapshot snapshot = seen();
    const Refusal& newest = snapshot.refusals[(snapshot.transactions_refused - 1) % refusals_shown];
    return snapshot.transactions_refused > 0 && newest.sequence == number ? refusal_text(newest, own) : "";
  }
  static Command to(std::uint32_t set) { return {.kind = CommandKind::switch_set, .index = set}; }
  Command set_kp(double value) const {
    const ParameterId kp = own.parameters.find("posture.knee.kp_Nm_per_rad").value();
    return {.kind = CommandKind::set_parameter, .index = kp, .value = value};
  }
  double kp() const { return own.parameters.get(set_kp(0).index); }
  Snapshot seen() const { return exchange->snapshot.newest(1); }
  double left_s() const { return own.signals.read(own.signals.find("composition.spare.dwell_s").value()); }
  ArmedState armed(std::uint32_t number) const {
    const Snapshot snapshot = seen();
    for (const ArmedStatus& status : snapshot.armed) {
      if (status.sequence == number) return status.state;
    }
    return ArmedState::none;
  }
};

Command arm(std::uint32_t conditions, std::uint32_t commands) {
  return {.kind = CommandKind::arm, .index = conditions, .count = conditions + commands, .duration_s = 10};
}

Command below(const char* signal, double value) {
  return {.kind = CommandKind::condition,
          .count = static_cast<std::uint32_t>(ConditionKind::below),
          .time_ns = signal_key(signal),
          .value = value};
}

}  // namespace

TEST_CASE("A switch that comes before the dwell of a set is over is refused with its whole transaction, to the tick") {
  for (const bool object : {false, true}) {
    CAPTURE(object);
    Stand stand(object);
    REQUIRE(stand.refusal({Stand::to(spare)}).empty());  // the sets of the start do not dwell
    CHECK(stand.refusal({stand.set_kp(70), Stand::to(posture)}) ==
          "control set posture: spare cannot be switched for another 0.049 s (switch_dwell_s)");
    CHECK(stand.kp() == 40);
    CHECK(stand.seen().control_sets == set_bit(spare));
    stand.ticks(dwell_ticks - 3);
    CHECK(!stand.refusal({stand.set_kp(70), Stand::to(posture)}).empty());
    CHECK(stand.refusal({stand.set_kp(70), Stand::to(posture)}).empty());
    CHECK(stand.seen().control_sets == set_bit(posture));
    CHECK(stand.kp() == 70);
    // It has left: it cannot come in again at once, either.
    CHECK(stand.refusal({Stand::to(spare)}) ==
          "control set spare: spare cannot be switched for another 0.049 s (switch_dwell_s)");
    stand.ticks(dwell_ticks - 2);
    CHECK(stand.refusal({Stand::to(spare)}).empty());
  }
}

TEST_CASE("Snapshot and signal show for how long it dwells: when they say 0, the next tick takes the switch") {
  for (const int waited : {0, dwell_ticks - 3, dwell_ticks - 2, dwell_ticks + 5}) {
    CAPTURE(waited);
    Stand stand;
    CHECK(stand.left_s() == 0);
    REQUIRE(stand.refusal({Stand::to(spare)}).empty());
    stand.ticks(waited);
    CHECK(stand.seen().objects[spare].dwell_s == doctest::Approx(std::max(0.0, 0.001 * (dwell_ticks - 1 - waited))));
    CHECK(stand.left_s() == doctest::Approx(stand.seen().objects[spare].dwell_s));
    const bool over = stand.left_s() == 0;
    CHECK(stand.refusal({Stand::to(posture)}).empty() == over);
  }
}

TEST_CASE("A set dwells with its name, an object with whatever set it is in") {
  Stand set(false), object(true);
  for (Stand* stand : {&set, &object}) REQUIRE(stand->refusal({Stand::to(spare)}).empty());
  CHECK(!set.refusal({Stand::to(2)}).empty());
  CHECK(object.refusal({Stand::to(2)}).empty());  // it goes on in the other set
  CHECK(!object.refusal({Stand::to(posture)}).empty());
}

TEST_CASE("One transaction cannot switch to a set that dwells and away again") {
  Stand stand;
  CHECK(stand.refusal({Stand::to(spare), Stand::to(posture)}) ==
        "control set posture: spare cannot be switched for another 0.050 s (switch_dwell_s)");
  CHECK(stand.seen().control_sets == set_bit(posture));
  CHECK(stand.refusal({Stand::to(spare), Stand::to(spare)}).empty());
  CHECK(stand.refusal({Stand::to(spare)}).empty());  // active already: no switch
}

TEST_CASE("What was armed is refused when its condition comes too early, and can wait for the dwell") {
  Stand stand;
  REQUIRE(stand.refusal({Stand::to(spare)}).empty());
  const Command now{.kind = CommandKind::condition, .count = static_cast<std::uint32_t>(ConditionKind::after)};
  const std::uint32_t early = stand.send({arm(1, 2), now, stand.set_kp(70), Stand::to(posture)});
  const std::uint32_t patient = stand.send({arm(1, 1), below("composition.spare.dwell_s", 0.0005), Stand::to(posture)});
  stand.ticks(1);
  CHECK(stand.armed(early) == ArmedState::refused);
  CHECK(stand.kp() == 40);
  CHECK(stand.armed(patient) == ArmedState::waits);
  stand.ticks(dwell_ticks - 2);
  CHECK(stand.armed(patient) == ArmedState::waits);
  stand.ticks(1);
  CHECK(stand.armed(patient) == ArmedState::done);
  CHECK(stand.seen().control_sets == set_bit(posture));
}

TEST_CASE("The dwell keeps the safety layer from nothing: it stops the robot, and what comes back starts at once") {
  Stand stand;
  REQUIRE(stand.refusal({Stand::to(spare)}).empty());
  stand.safety.emergency_stop().ask({});
  stand.ticks(1);
  CHECK(stand.engine.state().status.safety.level >= SafetyLevel::damp);
  stand.safety.emergency_stop().lift();
  stand.ticks(2);
  CHECK(stand.engine.state().status.safety.level <= SafetyLevel::limited);
  CHECK(!stand.refusal({Stand::to(posture)}).empty());  // the start anew was no switch, the dwell goes on
}

TEST_CASE("A thousand switches that come too early take no memory and are each refused") {
  Stand stand;
  REQUIRE(stand.refusal({Stand::to(spare)}).empty());
  const std::uint32_t before = stand.seen().transactions_refused;
  const testing::AllocationCount heap;
  for (int i = 0; i < dwell_ticks - 1; ++i) {
    for (int k = 0; k < 20; ++k) (void)stand.send({Stand::to(posture)});
    stand.ticks(1);
  }
  const long allocations = heap.count();
  CHECK(allocations == 0);
  CHECK(stand.seen().transactions_refused - before == (dwell_ticks - 1) * 20);
  CHECK(stand.seen().control_sets == set_bit(spare));
}

TEST_CASE("A robot that demands no dwell has no signal of it, and a demand out of range is refused") {
  const bench::Robot robot;
  for (const std::string& name : robot.catalog.signals.names()) CHECK(name.find("dwell_s") == std::string::npos);
  Catalog catalog;
  auto objects = bench::posture(catalog, robot.model);
  catalog.sets[spare].switch_dwell_s = -1;
  CHECK_THROWS_WITH_AS(ControlSets(catalog, std::move(objects)),
                       "control set spare: switch_dwell_s is -1.000000, must be 0..60 s", std::invalid_argument);
}

}  // namespace switch_dwell_test
