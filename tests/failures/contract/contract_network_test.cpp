// Rows of the failure contract for a plant on another machine: what the network does to datagrams is drawn from a seed
// and happens step by step.
#include <doctest/doctest.h>

#include "engine/bench.h"
#include "plant/lossy_wire.h"
#include "plant/udp/plant_server.h"
#include "plant/udp/udp_plant.h"

namespace contract_network_test {

using namespace kadans;
using doctest::description;
using kadans::test::LossyWire;

namespace {

constexpr std::int64_t tick_ns = 1'000'000;

// The robot of bench.h; a tick of control, a beat of the plant, and the wire between them, in turn.
struct RemoteRobot {
  PlantLayout layout{.robot = "bench", .joints = {"hip", "knee"}, .feet = {}, .period_ns = tick_ns};
  UdpSettings udp{.peer = "the test"};
  RobotModel model = bench::robot();
  LossyWire wire{7};
  IdealWorld plant{model, bench::plant_settings()};
  PlantServer server{udp, layout, wire.plant_end()};
  UdpPlant seen{udp, layout, wire.control_end(), 1};
  EngineSettings settings;
  Catalog catalog;
  Estimator estimator{model, {}, 0.001};
  Safety safety{bench::safety_settings(), model};
  std::vector<std::unique_ptr<ControlObject>> objects = bench::posture(catalog, model);
  ControlSets sets{catalog, std::move(objects)};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control{settings, seen, estimator, safety, sets, catalog, *exchange};
  BehaviorEngine behaviors{sets, *exchange, nullptr};
  std::int64_t time_ns = 0;
  double effort_max_Nm = 0;

  RemoteRobot() {
    (void)seen.greet();
    wire.step();
    REQUIRE(server.await(0));
    REQUIRE(server.beat(plant, 1));
    wire.step();
    REQUIRE(seen.welcomed());
    run(10);
    move_hip(0.5);
  }
  void move_hip(double to_rad) {
    const SetpointId hip = catalog.setpoints.find("posture.hip.position_rad").value();
    CommandSender& sender = behaviors.sender();
    sender.begin(time_ns);
    REQUIRE(sender.add({.kind = CommandKind::set_point, .index = hip, .value = to_rad, .duration_s = 0.5}));
    REQUIRE(sender.commit());
  }
  void run(int ticks, bool driven = true) {
    for (int i = 0; i < ticks; ++i, time_ns += tick_ns) {
      if (driven) control.tick(time_ns, 0.001, 0);
      if (driven && time_ns % (10 * tick_ns) == 0) behaviors.tick(time_ns);
      wire.step();
      (void)server.beat(plant, 1);
      wire.step();
      for (std::size_t j = 0; j < 2; ++j)
        effort_max_Nm = std::max(effort_max_Nm, std::abs(plant.truth().drive_torque_Nm[j]));
    }
  }
  double hip_rad() const { return plant.truth().position_rad[0]; }
  const SafetyStatus& status() const { return control.state().status.safety; }
};

}  // namespace

TEST_SUITE_BEGIN("contract");

TEST_CASE("within the bounds the robot goes where it is told: nothing is noticed but by the counts" *
          description("datagrams of a plant over the network are lost, late, twice or out of order")) {
  RemoteRobot robot;
  robot.wire.to_control = robot.wire.to_plant = {.loss = 0.1, .twice = 0.1, .delay_max_steps = 3};
  robot.run(3000);
  CHECK(robot.hip_rad() == doctest::Approx(0.5).epsilon(0.05));
  CHECK(robot.status().level == SafetyLevel::normal);
  CHECK(robot.status().fault_count == 0);
  const DatagramCounts& samples = robot.seen.statistics();
  CHECK(samples.lost > 150);
  CHECK(samples.reordered > 100);
  CHECK(samples.duplicates > 100);
  CHECK(samples.refused == 0);
  CHECK(robot.server.link().lost > 150);
  CHECK(robot.server.session().releases == 0);
}

TEST_CASE("after silent_ticks_max ticks every sensor is silent: the joints are off, latched" *
          description("no sample of a plant over the network arrives any more")) {
  RemoteRobot robot;
  robot.run(700);
  robot.wire.to_control.loss = 1;
  const auto bound = static_cast<int>(robot.safety.settings().silent_ticks_max);
  robot.run(bound);
  CHECK(robot.status().level == SafetyLevel::normal);
  robot.run(2);
  CHECK(robot.status().level == SafetyLevel::off);
  CHECK(robot.status().first_fault.code == FaultCode::sensor_silent);
  robot.wire.to_control.loss = 0;
  robot.run(100);
  CHECK(robot.status().level == SafetyLevel::off);
}

TEST_CASE("its watchdog damps the joints, and what it tells counts as silent after round_trip_max_s" *
          description("no actuation reaches a plant over the network any more")) {
  RemoteRobot robot;
  robot.run(200);  // it moves
  const double speed_rad_s = std::abs(robot.plant.truth().velocity_rad_s[0]);
  CHECK(speed_rad_s > 0.2);
  robot.wire.to_plant.loss = 1;
  robot.run(10);
  CHECK(robot.status().level == SafetyLevel::normal);
  robot.run(8);
  CHECK(robot.status().first_fault.code == FaultCode::sensor_silent);
  CHECK(robot.status().level == SafetyLevel::off);
  CHECK_FALSE(robot.server.released());
  robot.run(5);
  CHECK(robot.server.released());
  robot.run(300);
  CHECK(std::abs(robot.plant.truth().velocity_rad_s[0]) < 0.05 * speed_rad_s);
  CHECK(robot.effort_max_Nm <= 20);
}

TEST_CASE("the plant's watchdog damps the joints within watchdog_s, and after peer_timeout_s it takes another peer" *
          description("the process that drives a plant over the network dies")) {
  RemoteRobot robot;
  robot.run(200);
  robot.run(22, false);
  CHECK(robot.server.released());
  robot.run(500, false);
  CHECK(std::abs(robot.plant.truth().velocity_rad_s[0]) < 0.01);
  robot.run(600, false);
  CHECK_FALSE(robot.server.beat(robot.plant, 1));
  CHECK(robot.server.session().releases == 1);
}

TEST_CASE("the next sample that is fresh counts, no sensor jumps or is silent" *
          description("the control thread stands still while samples of a plant over the network pile up")) {
  RemoteRobot robot;
  robot.run(200);
  for (const int gap : {60, 3, 15, 85}) {
    robot.run(gap, false);
    robot.control.tick(robot.time_ns, 0.001 * (gap + 1), static_cast<std::uint32_t>(gap));
    robot.run(100);
  }
  CHECK(robot.status().level == SafetyLevel::normal);
  CHECK(robot.status().first_fault.code == FaultCode::tick_overrun);
  robot.run(1000);
  CHECK(robot.hip_rad() == doctest::Approx(0.5).epsilon(0.05));
}

TEST_SUITE_END();

}  // namespace contract_network_test
