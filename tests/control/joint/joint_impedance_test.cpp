#include <map>
#include <string>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "control/object_bench.h"

namespace joint_impedance_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

ObjectBench tuned() {
  ObjectBench bench(make_joint_impedance);
  bench.set("hip.stiffness_Nm_per_rad", 30);
  bench.set("hip.damping_Nms_per_rad", 2);
  bench.start();
  return bench;
}

}  // namespace

TEST_CASE("JointImpedance gives way to a load as its spring does, and not at all when the load is fed forward") {
  ObjectBench bench = tuned();
  bench.run(3000);
  CHECK(bench.hip().position_rad == doctest::Approx(-ObjectBench::load_Nm / 30));
  CHECK(bench.signal("hip.deflection_rad") == doctest::Approx(ObjectBench::load_Nm / 30));
  bench.set_point("hip.effort_Nm", ObjectBench::load_Nm, 0.2);
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.2));
  bench.run(3000);
  CHECK(std::abs(bench.hip().position_rad) < 1e-4);
  CHECK(bench.signal("hip.reference_effort_Nm") == ObjectBench::load_Nm);
}

TEST_CASE("JointImpedance damps the motion against its reference") {
  ObjectBench bench = tuned();
  bench.joints.joints[0] = {.velocity_rad_s = 1.0};
  bench.compute();
  CHECK(bench.computed.joints[0].effort_Nm == doctest::Approx(-2.0));
  CHECK(bench.computed.joints[0].mode == ActuationMode::effort);
}

TEST_CASE("JointImpedance limits the torque and says so") {
  ObjectBench bench = tuned();
  bench.set("hip.effort_max_Nm", 2);
  bench.set_point("hip.position_rad", 1, 0);
  bench.compute();
  CHECK(bench.computed.joints[0].effort_Nm == 2);
  CHECK(bench.signal("hip.saturated") == 1);
  CHECK(bench.signal("knee.saturated") == 0);
}

TEST_CASE("JointImpedance whose loop is the drive's hands it spring, damper and reference, and bounds its own torque") {
  ObjectBench bench([](const ObjectSetup& setup) {
    ObjectSetup in_drive = setup;
    in_drive.options = std::map<std::string, std::string>{{"loop", "drive"}};
    return make_joint_impedance(in_drive);
  });
  bench.set("hip.stiffness_Nm_per_rad", 30);
  bench.set("hip.damping_Nms_per_rad", 2);
  bench.set("hip.effort_max_Nm", 2);
  bench.start();
  bench.set_point("hip.position_rad", 0.4, 0);
  bench.set_point("hip.effort_Nm", 3, 0);
  bench.compute();
  const JointActuation& asked = bench.computed.joints[0];
  CHECK(asked.mode == ActuationMode::impedance);
  CHECK(asked.position_rad == doctest::Approx(0.4));
  CHECK(asked.stiffness_Nm_per_rad == 30);
  CHECK(asked.damping_Nms_per_rad == 2);
  CHECK(asked.effort_Nm == 2);
  const std::map<std::string, std::string> elsewhere{{"loop", "there"}};
  CHECK_THROWS_AS(make_joint_impedance({bench.model, {0}, ObjectOptions(elsewhere)}), OptionError);
}

TEST_CASE("JointImpedance cancels position and torque each by itself") {
  ObjectBench bench = tuned();
  bench.set_point("hip.position_rad", 1, 1.0);
  bench.set_point("hip.effort_Nm", 3, 2.0);
  bench.run(500);
  bench.cancel("hip.effort_Nm");
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.5).epsilon(0.01));
  bench.cancel("hip.position_rad");
  CHECK(bench.motion_remaining_s() <= 0.1);
  bench.run(200);
  CHECK(bench.signal("hip.reference_rad") < 0.7);
  CHECK(bench.signal("hip.reference_effort_Nm") < 1.5);
}

}  // namespace joint_impedance_test
