#include "kadans/control/joint_pid.h"

#include <doctest/doctest.h>

#include "kadans/control/catalog.h"
#include "kadans/testing/allocation_count.h"
#include "two_joint_robot.h"

using namespace kadans;

namespace {

struct Bench {
  RobotModel model = two_joint_robot();
  Catalog catalog;
  JointPid object{{model, {0, 1}}};
  JointStates joints;
  RobotStatus status;
  ActuationFrame written, computed;

  Bench() {
    Declaration declaration("posture", 0, catalog.parameters, catalog.setpoints, catalog.signals);
    object.declare(declaration);
    joints.count = written.joint_count = computed.joint_count = 3;
  }
  void set(const char* parameter, double value) {
    REQUIRE(catalog.parameters.set(catalog.parameters.find(parameter).value(), value));
  }
  ControlInput input() const { return {joints, status, written, 0, 0.001}; }
};

}  // namespace

TEST_CASE("JointPid declares its parameters, set-points and signals by joint") {
  const Bench bench;
  CHECK(bench.catalog.parameters.find("posture.knee.kp_Nm_per_rad"));
  CHECK(bench.catalog.signals.find("control.posture.hip.effort_Nm"));
  const SetpointId id = bench.catalog.setpoints.find("posture.knee.position_rad").value();
  CHECK(bench.catalog.setpoints[id].min == -1);
  CHECK(bench.catalog.setpoints[id].max == 2);
  CHECK(bench.catalog.setpoints[id].channel == 1);
  CHECK(bench.catalog.parameters.info(bench.catalog.parameters.find("posture.hip.effort_max_Nm").value()).initial ==
        20);
}

TEST_CASE("JointPid refuses a passive joint") {
  const RobotModel model = two_joint_robot();
  CHECK_THROWS_WITH_AS(JointPid({model, {2}}), "joint toe is passive: it has no motor to control",
                       std::invalid_argument);
}

TEST_CASE("JointPid drives each joint to its own set-point in effort mode") {
  Bench bench;
  bench.set("posture.hip.kp_Nm_per_rad", 10);
  bench.set("posture.knee.kp_Nm_per_rad", 5);
  bench.object.start(bench.input());
  bench.object.set_point(0, 0.5, 0);
  bench.object.set_point(1, -0.5, 0);
  bench.object.step(bench.input(), bench.computed);
  CHECK(bench.computed.joints[0].mode == ActuationMode::effort);
  CHECK(bench.computed.joints[0].effort_Nm == doctest::Approx(5.0));
  CHECK(bench.computed.joints[1].effort_Nm == doctest::Approx(-2.5));
  CHECK(bench.computed.joints[2].mode == ActuationMode::off);
}

TEST_CASE("JointPid starts where the joints are and with the torque that was there") {
  Bench bench;
  bench.set("posture.hip.kp_Nm_per_rad", 100);
  bench.joints.joints[0] = {.position_rad = 0.3, .velocity_rad_s = 0, .effort_Nm = 4};
  bench.written.joints[0] = {.effort_Nm = 4, .mode = ActuationMode::effort};
  bench.object.start(bench.input());
  bench.object.step(bench.input(), bench.computed);
  CHECK(bench.computed.joints[0].effort_Nm == doctest::Approx(4.0));
}

TEST_CASE("JointPid says how long its motions last") {
  Bench bench;
  bench.object.start(bench.input());
  CHECK(bench.object.motion_remaining_s() == 0);
  bench.object.set_point(0, 0.5, 0.4);
  bench.object.set_point(1, 0.5, 0.7);
  CHECK(bench.object.motion_remaining_s() == doctest::Approx(0.7));
  bench.object.cancel_motion(1);
  CHECK(bench.object.motion_remaining_s() == doctest::Approx(0.4));
}

TEST_CASE("JointPid steps, moves and cancels without allocating") {
  Bench bench;
  const kadans::testing::AllocationCount heap;
  bench.object.start(bench.input());
  bench.object.set_point(0, 0.5, 0.4);
  bench.object.step(bench.input(), bench.computed);
  bench.object.cancel_motion(0);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}
