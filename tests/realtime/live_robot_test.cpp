// The engines on real threads, and the rungs of the ladder that only threads can bring about. ThreadSanitizer looks on
// when the project's tests run this again.
#include "live_robot.h"

#include <stdexcept>

#include <doctest/doctest.h>

using namespace kadans;

TEST_CASE("Engines and model on three threads reach the set-points that a behavior gives") {
  LiveRobot robot;
  const SetpointId hip = robot.catalog.setpoints.find("posture.hip.position_rad").value();
  CommandSender& sender = robot.behaviors.sender();
  robot.script.at = [&](std::int64_t time_ns) {
    sender.begin(time_ns);
    (void)sender.add({.kind = CommandKind::set_point, .index = hip, .value = 0.5, .duration_s = 0.2});
    if (time_ns < 20 * tick_ns) (void)sender.commit();
  };
  robot.start();
  const Snapshot& snapshot = robot.run_until(1500);
  CHECK(snapshot.joints.joints[0].position_rad == doctest::Approx(0.5).epsilon(0.02));
  CHECK(snapshot.status.safety.level == SafetyLevel::normal);
  CHECK(snapshot.transactions_applied == 2);
  robot.stop();
  CHECK(robot.control_task.ticks() == robot.control_thread.statistics().lateness.count());
  CHECK(robot.control_task.ticks() >= 1500);
  CHECK(robot.control_thread.statistics().missed.get() == 0);
  CHECK(robot.plant_task.lost_periods() == 0);
}

TEST_CASE("The behavior thread sees parameters while the control thread sets them") {
  LiveRobot robot;
  const ParameterId kp = robot.catalog.parameters.find("posture.hip.kp_Nm_per_rad").value();
  CommandSender& sender = robot.behaviors.sender();
  double last = 40;
  bool in_order = true;
  robot.script.at = [&](std::int64_t time_ns) {
    const double now = robot.catalog.parameters.newest(kp);
    in_order = in_order && (now == last || now == last + 1);
    last = now;
    sender.begin(time_ns);
    (void)sender.add({.kind = CommandKind::set_parameter, .index = kp, .value = now + 1});
    (void)sender.commit();
  };
  robot.start();
  (void)robot.run_until(500);
  robot.stop();
  CHECK(in_order);
  CHECK(last >= 80);
}

TEST_CASE("A behavior thread that dies leaves the robot held, then damped, then off") {
  LiveRobot robot;
  robot.script.at = [](std::int64_t time_ns) {
    if (time_ns > 300 * tick_ns) throw std::runtime_error("a high level failed");
  };
  robot.start();
  CHECK(robot.run_until(300).status.safety.level == SafetyLevel::normal);
  CHECK(robot.run_until(500).status.safety.level == SafetyLevel::hold);
  robot.behavior_thread.join();
  CHECK(robot.behavior_thread.over());
  CHECK(std::string(robot.behavior_thread.failure()) == "a high level failed");
  const SafetySettings& limits = robot.safety.settings();
  const auto damps_ms = static_cast<std::int64_t>(500 + 1000 * limits.hold_s);
  CHECK(robot.run_until(damps_ms).status.safety.level == SafetyLevel::damp);
  CHECK(robot.run_until(damps_ms + static_cast<std::int64_t>(1000 * limits.damp_s)).status.safety.level ==
        SafetyLevel::off);
  robot.stop();
}

TEST_CASE("Control ticks that come late are told so, are counted, and no burst follows") {
  LiveRobot robot;
  robot.control_wait.late_from_ns = 200 * tick_ns;
  robot.control_wait.late_by_ns = 3 * tick_ns + tick_ns / 5;
  robot.control_wait.late_times = 1;
  robot.start();
  const Snapshot& snapshot = robot.run_until(400);
  CHECK(snapshot.tick == 396);  // numbered from 0: 400 grid points, three left out
  CHECK(snapshot.status.safety.first_fault.code == FaultCode::tick_overrun);
  CHECK(snapshot.status.safety.first_fault.value == 3);
  CHECK(snapshot.status.safety.level == SafetyLevel::normal);
  robot.stop();
  CHECK(robot.control_thread.statistics().missed.get() == 3);
  CHECK(robot.control_thread.statistics().late_wakes.get() == 1);
}

TEST_CASE("A control thread that is late again and again ends in damping") {
  LiveRobot robot;
  robot.control_wait.late_from_ns = 200 * tick_ns;
  robot.control_wait.late_by_ns = 2 * tick_ns;
  robot.control_wait.late_times = 50;
  robot.start();
  CHECK(robot.run_until(600).status.safety.level == SafetyLevel::damp);
  robot.stop();
  CHECK(robot.control_thread.statistics().missed.get() == 100);
}

TEST_CASE("A control thread whose clock stands still ends, says why, and its ticks do not count on") {
  LiveRobot robot;
  robot.control_wait.frozen_at_ns_ = 250 * tick_ns;
  robot.start();
  (void)robot.run_until(400);
  robot.control_thread.join();  // time goes on before the thread's last instruction
  CHECK(robot.control_thread.over());
  CHECK(std::string(robot.control_thread.failure()) == "the clock stands still");
  const std::uint64_t ticks = robot.control_task.ticks();
  CHECK(ticks <= 250);
  (void)robot.run_until(500);
  CHECK(robot.control_task.ticks() == ticks);  // so the service's watchdog is not fed
  robot.stop();
}

TEST_CASE("Whoever ends the run brings the robot down the ladder, and it stays there") {
  LiveRobot robot;
  robot.start();
  CHECK(robot.run_until(100).status.safety.level == SafetyLevel::normal);
  robot.safety.emergency_stop().leave();
  CHECK(robot.run_until(110).status.safety.level == SafetyLevel::damp);
  const int down = static_cast<int>(std::ceil(1e3 * robot.safety.settings().damp_s));
  const Snapshot off = robot.run_until(110 + down);
  CHECK(off.status.safety.level == SafetyLevel::off);
  CHECK(off.status.safety.fault_count == 0);  // nothing failed
  CHECK(robot.control.actuation().joint_count == 2);
  robot.stop();
}

TEST_CASE("A model that comes late catches up a little, and the rest of the time is counted as lost for it") {
  IdealWorld plant(bench::robot(), bench::plant_settings());
  const auto link = std::make_unique<PlantExchange>();
  PlantTask task(*link, plant, tick_ns);
  CHECK(task.beat({.missed = 3}));
  CHECK(link->sensors.newest().time_ns == 4 * tick_ns);
  CHECK(task.lost_periods() == 0);
  CHECK(task.beat({.missed = 25}));
  CHECK(link->sensors.newest().time_ns == 14 * tick_ns);
  CHECK(task.lost_periods() == 16);
}
