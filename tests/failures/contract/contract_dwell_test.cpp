// The row of the failure contract on switches that come too early.
#include <doctest/doctest.h>

#include "engine/bench.h"
#include "engine/transaction.h"

namespace contract_dwell_test {

using namespace kadans;
using doctest::description;

namespace {

constexpr std::uint32_t posture = 0, spare = 1;
constexpr double dwell_s = 0.05;

std::vector<std::unique_ptr<ControlObject>> dwelling(Catalog& catalog, const RobotModel& model) {
  auto objects = bench::posture(catalog, model);
  catalog.sets[spare].switch_dwell_s = dwell_s;
  return objects;
}

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("refused whole with the time that is left, nothing is delayed, and the safety layer waits for nothing" *
          description("a control set is switched again before its switch_dwell_s is over")) {
  bench::Robot robot;
  Catalog catalog;
  ControlSets sets(catalog, dwelling(catalog, robot.model));
  ControlEngine engine(robot.settings, robot.plant, robot.estimator, robot.safety, sets, catalog, *robot.exchange);
  CommandSender sender(robot.exchange->commands);
  std::int64_t time_ns = 0;
  const auto tick = [&](int count) {
    for (int i = 0; i < count; ++i, time_ns += 1'000'000) {
      robot.exchange->heartbeat.publish(time_ns);
      engine.tick(time_ns, 0.001);
      robot.plant.step(1'000'000);
    }
  };
  const auto switch_to = [&](std::uint32_t set) {
    sender.begin(time_ns);
    REQUIRE(sender.add({.kind = CommandKind::switch_set, .index = set}));
    (void)sender.commit();
    tick(1);
    return robot.exchange->snapshot.newest(1);
  };
  tick(5);
  CHECK(switch_to(spare).control_sets == set_bit(spare));
  const Snapshot early = switch_to(posture);
  CHECK(early.control_sets == set_bit(spare));
  REQUIRE(early.transactions_refused == 1);
  CHECK(early.refusals[0].reason == RefusalReason::set_dwells);
  CHECK(early.refusals[0].value == doctest::Approx(dwell_s - 0.001));
  tick(100);
  CHECK(robot.exchange->snapshot.newest(1).control_sets == set_bit(spare));
  CHECK(switch_to(posture).control_sets == set_bit(posture));
  robot.safety.emergency_stop().ask({});
  tick(1);
  CHECK(engine.state().status.safety.level >= SafetyLevel::damp);
}

TEST_SUITE_END();

}  // namespace contract_dwell_test
