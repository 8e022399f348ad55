// What holds for every control object that works joint by joint.
#include <cmath>
#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/joint/trajectory_list.h"
#include "kadans/testing/allocation_count.h"
#include "kadans/testing/real_time_guard.h"
#include "made_objects.h"
#include "object_bench.h"

namespace every_object_test {

using namespace kadans;
using kadans::test::ObjectBench;

namespace {

struct Type {
  const char* name;
  std::unique_ptr<ControlObject> (*make)(const ObjectSetup&);
  const char* setpoint;
};
constexpr Type types[] = {{"joint_pid", make_joint_pid, "position_rad"},
                          {"joint_cascade", make_joint_cascade, "position_rad"},
                          {"joint_impedance", make_joint_impedance, "position_rad"},
                          {"joint_integrator", make_joint_integrator, "velocity_rad_s"},
                          {"joint_velocity", make_joint_velocity, "velocity_rad_s"},
                          {"trajectory_list", make_trajectory_list, "position_rad"},
                          {"profile_position", make_profile_position, "position_rad"},
                          {"feedforward_player", make_feedforward_player, "amplitude"}};

ObjectBench tuned(const Type& type) {
  ObjectBench bench(type.make);
  for (const std::string joint : {"hip.", "knee."}) {
    bench.set_if_there(joint + "kp_Nm_per_rad", 100);
    bench.set_if_there(joint + "ki_Nm_per_rads", 200);
    bench.set_if_there(joint + "kd_Nms_per_rad", 4);
    bench.set_if_there(joint + "kp_per_s", 20);
    bench.set_if_there(joint + "kv_Nms_per_rad", 4);
    bench.set_if_there(joint + "ki_Nm_per_rad", 40);
    bench.set_if_there(joint + "acceleration_max_rad_s2", 100);
    bench.set_if_there(joint + "jerk_max_rad_s3", 10000);
    bench.set_if_there(joint + "stiffness_Nm_per_rad", 100);
    bench.set_if_there(joint + "damping_Nms_per_rad", 4);
    bench.set_if_there(joint + "position_sin1_rad", 0.2);
    bench.set_if_there(joint + "effort_cos2_Nm", 2);
  }
  return bench;
}

// What drove the hip before: a load held, or a motion at constant velocity, in one of the modes.
void drive_before(ObjectBench& bench, ActuationMode mode, double velocity_rad_s) {
  JointState& joint = bench.joints.joints[0];
  joint = {.position_rad = -0.2, .velocity_rad_s = velocity_rad_s};
  for (int i = 0; i < 300; ++i) {
    const double there_rad = -0.2 + velocity_rad_s * ObjectBench::dt_s * (i + 1);
    bench.written.joints[0] = {.effort_Nm = mode == ActuationMode::effort ? ObjectBench::load_Nm : 0,
                               .position_rad = there_rad,
                               .velocity_rad_s = velocity_rad_s,
                               .stiffness_Nm_per_rad = 300,
                               .damping_Nms_per_rad = 6,
                               .mode = mode};
    if (i < 299) ObjectBench::move(joint, bench.written.joints[0]);
  }
}

}  // namespace

TEST_CASE("Every object refuses a passive joint") {
  const RobotModel model = two_joint_robot();
  for (const Type& type : types) {
    CAPTURE(type.name);
    CHECK_THROWS_WITH_AS(type.make({model, {2}}), "joint toe is passive: it has no motor to control",
                         std::invalid_argument);
  }
}

TEST_CASE("Every object takes over from each mode without a step in the drive's torque") {
  for (const Type& type : types) {
    for (const ActuationMode mode :
         {ActuationMode::effort, ActuationMode::position, ActuationMode::velocity, ActuationMode::impedance}) {
      for (const double velocity_rad_s : {0.0, 1.5}) {
        ObjectBench bench = tuned(type);
        drive_before(bench, mode, velocity_rad_s);
        bench.start();
        bench.compute();
        ObjectBench::move(bench.joints.joints[0], bench.written.joints[0]);
        double last_Nm = bench.hip().effort_Nm, largest_Nm = 0;
        for (int i = 0; i < 5; ++i) {
          bench.tick();
          largest_Nm = std::max(largest_Nm, std::abs(bench.hip().effort_Nm - last_Nm));
          last_Nm = bench.hip().effort_Nm;
        }
        CAPTURE(type.name);
        CAPTURE(static_cast<int>(mode));
        CAPTURE(velocity_rad_s);
        CHECK(largest_Nm < 0.02 * bench.model.joints[0].effort_max_Nm);
      }
    }
  }
}

TEST_CASE("Every object brings a joint that it takes over in motion to rest, and carries the load") {
  for (const Type& type : types) {
    ObjectBench bench = tuned(type);
    drive_before(bench, ActuationMode::effort, 1.0);
    bench.start();
    bench.run(1000);
    CAPTURE(type.name);
    CHECK(std::abs(bench.hip().velocity_rad_s) < 0.01);
    CHECK(bench.hip().effort_Nm == doctest::Approx(ObjectBench::load_Nm).epsilon(0.01));
    CHECK(bench.motion_remaining_s() == 0);
    CHECK(bench.computed.joints[2].mode == ActuationMode::off);
  }
}

TEST_CASE(
    "A joint measured as NaN gets an actuation that is not finite, the other works on, and both work afterwards") {
  for (const Type& type : types) {
    ObjectBench bench = tuned(type);
    bench.start();
    bench.run(10);
    const JointState good = bench.joints.joints[0];
    bench.joints.joints[0].velocity_rad_s = std::numeric_limits<double>::quiet_NaN();
    bench.compute();
    CAPTURE(type.name);
    CHECK_FALSE(is_finite(bench.computed.joints[0]));
    CHECK(is_finite(bench.computed.joints[1]));
    bench.joints.joints[0] = good;
    bench.written.joints[0] = {};  // as the safety layer left it
    bench.compute();
    CHECK(is_finite(bench.computed.joints[0]));
    bench.run(300);
    CHECK(is_finite(bench.computed.joints[0]));
    CHECK(std::isfinite(bench.hip().position_rad));
  }
}

TEST_CASE("Every object in effort mode keeps its torque within its bound, and says so") {
  int limited = 0;
  for (const Type& type : types) {
    ObjectBench bench = tuned(type);
    bench.set_if_there("hip.effort_max_Nm", 2);
    bench.start();
    bench.compute();
    if (bench.computed.joints[0].mode != ActuationMode::effort) continue;
    bench.joints.joints[0].position_rad = -0.9;
    bench.compute();
    CAPTURE(type.name);
    CHECK(bench.computed.joints[0].effort_Nm == 2);
    CHECK(bench.signal("hip.saturated") == 1);
    CHECK(bench.signal("knee.saturated") == 0);
    ++limited;
  }
  CHECK(limited == 5);
}

TEST_CASE("Every object moves towards its set-point and says for how long") {
  for (const Type& type : types) {
    ObjectBench bench = tuned(type);
    bench.joints.joints[0].effort_Nm = bench.joints.joints[1].effort_Nm = ObjectBench::load_Nm;
    for (auto& joint : bench.computed.joints)
      joint = {.effort_Nm = ObjectBench::load_Nm, .mode = ActuationMode::effort};
    bench.written = bench.computed;
    bench.start();
    bench.compute();
    bench.set_point(std::string("hip.") + type.setpoint, 0.5, 0.4);
    bench.tick();
    CAPTURE(type.name);
    CHECK(bench.motion_remaining_s() == doctest::Approx(0.4).epsilon(0.01));
    bench.run(2000);
    CHECK(bench.motion_remaining_s() == 0);
    bench.cancel(std::string("hip.") + type.setpoint);
    bench.run(1000);
    CHECK(bench.motion_remaining_s() == 0);
    if (std::string(type.setpoint) == "position_rad")
      CHECK(bench.hip().position_rad == doctest::Approx(0.5).epsilon(0.02));
  }
}

TEST_CASE("No object allocates, locks or waits in the tick") {
  for (const Type& type : types) {
    ObjectBench bench = tuned(type);
    long allocations = 0;
    {
      const kadans::testing::RealTimeGuard guard;
      const kadans::testing::AllocationCount heap;
      bench.start();
      bench.run(10);
      bench.set_point(0, 0.5, 0.05);
      bench.run(20);
      bench.set_point(0, 0.1, 0);
      bench.run(20);
      bench.cancel_motion(0);
      bench.run(20);
      (void)bench.motion_remaining_s();
      allocations = heap.count();
    }
    CAPTURE(type.name);
    CHECK(allocations == 0);
  }
}

}  // namespace every_object_test
