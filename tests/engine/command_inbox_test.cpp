#include "engine/tick/command_inbox.h"

#include <array>
#include <limits>

#include <doctest/doctest.h>

#include "bench.h"
#include "engine/transaction.h"

using namespace kadans;

namespace {

struct Inbox : bench::Robot {
  CommandInbox inbox{exchange->commands, catalog, sets, 256, 100'000'000};
  CommandSender sender{exchange->commands};
  ActuationFrame computed;

  ParameterId parameter(const char* name) const { return catalog.parameters.find(name).value(); }
  Command set_kp(double value) const {
    return {.kind = CommandKind::set_parameter, .index = parameter("posture.knee.kp_Nm_per_rad"), .value = value};
  }
  Command move_hip(double value, double duration_s = 0) const {
    return {.kind = CommandKind::set_point,
            .index = catalog.setpoints.find("posture.hip.position_rad").value(),
            .value = value,
            .duration_s = duration_s};
  }
  template <typename... Commands>
  void send(std::int64_t time_ns, const Commands&... commands) {
    sender.begin(time_ns);
    for (const Command& command : {commands...}) REQUIRE(sender.add(command));
    REQUIRE(sender.commit() > 0);
  }
  ControlInput at(std::int64_t time_ns) const {
    return {control.state().joints, control.state().status, control.actuation(), time_ns, 0.001};
  }
  double kp() const { return catalog.parameters.get(parameter("posture.knee.kp_Nm_per_rad")); }
};

}  // namespace

TEST_CASE("A transaction is applied whole, in one tick") {
  Inbox bench;
  bench.sets.start_newcomers(bench.at(0));
  bench.send(0, bench.set_kp(77), bench.move_hip(0.5, 1.0));
  bench.inbox.apply(1, bench.at(1'000'000), bench.safety);
  CHECK(bench.kp() == 77);
  CHECK(bench.inbox.motions().remaining_s(0) == 1.0);
  CHECK(bench.inbox.state().last_transaction == 1);
  CHECK(bench.inbox.state().applied == 2);
  CHECK(bench.inbox.state().refused == 0);
}

TEST_CASE("A set-point behind a switch in the same transaction counts for the objects that come in") {
  Inbox bench;
  const SetpointId knee = bench.catalog.setpoints.find("spare.knee.position_rad").value();
  bench.send(0, Command{.kind = CommandKind::switch_set, .index = 1},
             Command{.kind = CommandKind::set_point, .index = knee, .value = 0.5, .duration_s = 1.0});
  bench.inbox.apply(1, bench.at(0), bench.safety);
  bench.inbox.motions().step(0.001);
  bench.sets.step(1, bench.at(0), bench.computed);
  CHECK(bench.sets.active() == 0b10);
  CHECK(bench.inbox.motions().remaining_s(1) == 1.0);  // the tick of the start passes no time
}

TEST_CASE("One bad command refuses its whole transaction, and the next one is applied") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Inbox bench;
  const std::array bad = {bench.set_kp(-1),
                          bench.set_kp(nan),
                          bench.move_hip(2.5),
                          bench.move_hip(nan),
                          bench.move_hip(0, -1),
                          bench.move_hip(0, nan),
                          Command{.kind = CommandKind::set_parameter, .index = 9999},
                          Command{.kind = CommandKind::set_point, .index = 9999},
                          Command{.kind = CommandKind::cancel_motion, .index = 9999},
                          Command{.kind = CommandKind::switch_set, .index = 2},
                          Command{.kind = CommandKind::transaction},
                          Command{.kind = static_cast<CommandKind>(99)}};
  for (const Command& command : bad) bench.send(0, bench.set_kp(99), command);
  bench.send(0, bench.set_kp(50));
  bench.inbox.apply(1, bench.at(0), bench.safety);
  CHECK(bench.kp() == 50);
  CHECK(bench.inbox.state().refused == 2 * bad.size());
  Fault fault;
  for (std::size_t i = 0; i < bad.size(); ++i) {
    REQUIRE(bench.safety.log().try_pop(fault));
    CHECK(fault.code == FaultCode::command_refused);
  }
}

TEST_CASE("A transaction that is too old expires") {
  Inbox bench;
  bench.send(0, bench.set_kp(77));
  bench.inbox.apply(1, bench.at(100'000'001), bench.safety);
  CHECK(bench.kp() == 40);
  CHECK(bench.inbox.state().refused == 1);
}

TEST_CASE("At most a fixed number of commands is applied in a tick, the rest waits its turn") {
  Inbox bench;
  for (int i = 0; i < 3; ++i) {
    bench.sender.begin(0);
    for (int j = 0; j < 120; ++j) REQUIRE(bench.sender.add(bench.set_kp(i)));
    REQUIRE(bench.sender.commit() > 0);
  }
  bench.inbox.apply(1, bench.at(0), bench.safety);
  CHECK(bench.inbox.state().applied == 240);
  CHECK(bench.kp() == 1);
  bench.inbox.apply(2, bench.at(0), bench.safety);
  CHECK(bench.inbox.state().applied == 360);
  CHECK(bench.kp() == 2);
}

TEST_CASE("A queue that does not hold transactions is emptied and reported, nothing is executed") {
  Inbox bench;
  const std::array torn = {Command{.kind = CommandKind::transaction, .count = 7}, bench.set_kp(99)};
  REQUIRE(bench.exchange->commands.try_push(torn));
  bench.inbox.apply(1, bench.at(0), bench.safety);
  CHECK(bench.kp() == 40);
  CHECK(bench.exchange->commands.size() == 0);
  CHECK(bench.inbox.state().refused == 2);
}

TEST_CASE("A tick's share that the largest transaction could never pass is refused before the loop") {
  bench::Robot robot;
  CHECK_THROWS_AS(CommandInbox(robot.exchange->commands, robot.catalog, robot.sets, 10, 0), std::invalid_argument);
}

TEST_CASE("A second order to a drive waits for the next tick, so that each stands in a frame") {
  Inbox bench;
  const auto order = [](DriveOrder what) {
    return Command{.kind = CommandKind::order_drive, .index = 1, .count = static_cast<std::uint32_t>(what)};
  };
  bench.send(0, order(DriveOrder::reset));
  bench.send(0, order(DriveOrder::enable));
  bench.inbox.apply(1, bench.at(0), bench.safety);
  CHECK(bench.inbox.drive_requests()[1].order == DriveOrder::reset);
  CHECK(bench.inbox.drive_requests()[1].number == 1);
  bench.inbox.apply(2, bench.at(0), bench.safety);
  CHECK(bench.inbox.drive_requests()[1].order == DriveOrder::enable);
  CHECK(bench.inbox.drive_requests()[1].number == 2);
}

TEST_CASE("The emergency stop takes back orders to drives that are not carried out yet") {
  Inbox bench;
  const auto order = [](std::uint32_t joint, DriveOrder what) {
    return Command{.kind = CommandKind::order_drive, .index = joint, .count = static_cast<std::uint32_t>(what)};
  };
  SensorFrame sensors;
  sensors.joint_count = 2;
  sensors.joints[0].drive = DriveState::ready;
  bench.send(0, order(0, DriveOrder::enable), order(1, DriveOrder::enable));
  bench.inbox.apply(1, bench.at(0), bench.safety);
  bench.inbox.revoke_orders(sensors);
  CHECK(bench.inbox.drive_requests()[0].order == DriveOrder::disable);  // it was under way
  CHECK(bench.inbox.drive_requests()[0].number == 2);
  CHECK(bench.inbox.drive_requests()[1].order == DriveOrder::none);  // it is enabled, and damps
  CHECK(bench.inbox.drive_requests()[1].number == 1);
  bench.send(0, order(0, DriveOrder::release), order(1, DriveOrder::brake));
  bench.inbox.apply(2, bench.at(0), bench.safety);
  bench.inbox.revoke_orders(sensors);
  CHECK(bench.inbox.drive_requests()[0].order == DriveOrder::none);
  CHECK(bench.inbox.drive_requests()[1].order == DriveOrder::brake);
}

TEST_CASE("An order to a drive that there is not, or that is none, is refused") {
  Inbox bench;
  bench.send(0, Command{.kind = CommandKind::order_drive, .index = 2, .count = 1});
  bench.send(0, Command{.kind = CommandKind::order_drive, .index = 0, .count = 0});
  bench.send(0, Command{.kind = CommandKind::order_drive, .index = 0, .count = 7});
  bench.inbox.apply(1, bench.at(0), bench.safety);
  CHECK(bench.inbox.state().applied == 0);
  CHECK(bench.inbox.state().refused == 3);
}
