#include <doctest/doctest.h>

#include "bench.h"
#include "kadans/testing/real_time_guard.h"

using namespace kadans;

TEST_CASE("A tick with commands, motions and a change of the control set keeps the rules of real time") {
  bench::Robot robot;
  CommandSender sender(robot.exchange->commands);
  const SetpointId hip = robot.catalog.setpoints.find("posture.hip.position_rad").value();
  for (int i = 0; i < 200; ++i) {
    const std::int64_t time_ns = i * 1'000'000;
    sender.begin(time_ns);
    REQUIRE(sender.add({.kind = CommandKind::set_point, .index = hip, .value = 0.01 * (i % 50), .duration_s = 0.1}));
    if (i % 50 == 49) REQUIRE(sender.add({.kind = CommandKind::switch_set, .index = i % 100 == 49 ? 1U : 0U}));
    REQUIRE(sender.commit() > 0);
    robot.exchange->heartbeat.publish(time_ns);
    {
      const kadans::testing::RealTimeGuard guard;
      robot.control.tick(time_ns, 0.001);
    }
    robot.plant.step(1'000'000);
  }
  CHECK(robot.control.inbox().state().refused == 0);
  CHECK(robot.control.state().status.safety.level == SafetyLevel::normal);
}
