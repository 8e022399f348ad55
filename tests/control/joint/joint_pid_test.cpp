// What JointPid adds to pid_test.cpp and every_object_test.cpp.
#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

using namespace kadans;
using kadans::test::ObjectBench;

TEST_CASE("JointPid declares its parameters, set-points and signals by joint") {
  const ObjectBench bench(make_joint_pid);
  CHECK(bench.catalog.parameters.find("it.knee.kp_Nm_per_rad"));
  CHECK(bench.catalog.signals.find("control.it.hip.effort_Nm"));
  const SetpointId id = bench.catalog.setpoints.find("it.knee.position_rad").value();
  CHECK(bench.catalog.setpoints[id].min == -1);
  CHECK(bench.catalog.setpoints[id].max == 2);
  CHECK(bench.catalog.setpoints[id].channel == 1);
  CHECK(bench.catalog.parameters.info(bench.catalog.parameters.find("it.hip.effort_max_Nm").value()).initial == 20);
}

TEST_CASE("JointPid drives each joint to its own set-point in effort mode") {
  ObjectBench bench(make_joint_pid);
  bench.set("hip.kp_Nm_per_rad", 10);
  bench.set("knee.kp_Nm_per_rad", 5);
  bench.start();
  bench.set_point("hip.position_rad", 0.5, 0);
  bench.set_point("knee.position_rad", -0.5, 0);
  bench.compute();
  CHECK(bench.computed.joints[0].mode == ActuationMode::effort);
  CHECK(bench.computed.joints[0].effort_Nm == doctest::Approx(5.0));
  CHECK(bench.computed.joints[1].effort_Nm == doctest::Approx(-2.5));
  CHECK(bench.computed.joints[2].mode == ActuationMode::off);
}

TEST_CASE("JointPid's integral takes over what a drive in position or velocity mode gave, as measured") {
  for (const ActuationMode mode : {ActuationMode::position, ActuationMode::velocity}) {
    ObjectBench bench(make_joint_pid);
    bench.set("hip.kp_Nm_per_rad", 100);
    bench.joints.joints[0] = {.position_rad = 0.3, .velocity_rad_s = 0, .effort_Nm = 4};
    bench.written.joints[0] = {.effort_Nm = 1, .position_rad = 0.31, .mode = mode};
    bench.start();
    bench.compute();
    CHECK(bench.computed.joints[0].effort_Nm == doctest::Approx(4.0));
    CHECK(bench.signal("hip.integral_Nm") == doctest::Approx(4.0));
  }
}

TEST_CASE("JointPid's longest motion is the one under way that ends last") {
  ObjectBench bench(make_joint_pid);
  bench.start();
  CHECK(bench.motion_remaining_s() == 0);
  bench.set_point("hip.position_rad", 0.5, 0.4);
  bench.set_point("knee.position_rad", 0.5, 0.7);
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.7));
  bench.cancel("knee.position_rad");
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.4));
}
