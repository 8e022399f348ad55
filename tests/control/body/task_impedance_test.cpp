#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "arm_bench.h"
#include "control/made_objects.h"
#include "kadans/control/limb_chain.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;
using kadans::test::ArmBench;

namespace {

// The point is the arm's end, 0.3 m below the elbow.
ArmBench tuned() {
  ArmBench bench(make_task_impedance, {{{"link", "fore"}}});
  bench.set("point_z_m", -0.3);
  for (const std::string direction : {"x.", "y.", "z."}) {
    bench.set(direction + "stiffness_N_per_m", 2000);
    bench.set(direction + "damping_Ns_per_m", 80);
  }
  return bench;
}

std::string refusal(ObjectOptions options, std::vector<std::size_t> joints) {
  const RobotModel model = kadans::test::arm();
  try {
    (void)make_task_impedance({model, std::move(joints), std::move(options)});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("TaskImpedance's Jacobian is that of the whole robot's dynamics") {
  const RobotModel model = kadans::test::arm();
  LimbChain chain(model, 2);
  Dynamics dynamics(model);
  const std::vector<double> q{0.4, -0.9, 0.1}, still(3, 0.0);
  JointStates joints;
  for (std::size_t i = 0; i < 3; ++i) joints.joints[i].position_rad = q[i];
  const Vec3 point_m{0.05, 0.02, -0.3};
  const Vec3 at = chain.update(joints, point_m);
  dynamics.update(q, still, {});
  Eigen::MatrixXd jacobian(6, 3);
  dynamics.link_jacobian(2, point_m, jacobian);
  const Vec3 expected = transform(dynamics.link(2), point_m);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(at[k] == doctest::Approx(expected[k]));
    for (std::size_t i = 0; i < 2; ++i) {
      CHECK(chain.segments()[i].column_m_per_rad[k] ==
            doctest::Approx(jacobian(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i))));
    }
  }
}

TEST_CASE("TaskImpedance keeps a set-point that it gets between its start and its first step") {
  ArmBench bench = tuned();
  bench.place(0.9, -1.4);
  bench.start();
  SetpointState at;
  REQUIRE(bench.object->setpoint_state(0, at));
  bench.set_point("x_m", at.value + 0.1, 0.5);
  bench.run(1);
  CHECK(bench.signal("x.reference_m") == doctest::Approx(bench.signal("x.position_m")).epsilon(1e-4));
  bench.run(1500);
  CHECK(bench.signal("x.reference_m") == doctest::Approx(at.value + 0.1));
  bench.start();
  bench.set_point("z_m", at.value, 0);
  bench.run(1);
  CHECK(bench.signal("z.reference_m") == at.value);
}

TEST_CASE("TaskImpedance gives way to a force as its springs say, and leads the point along its reference") {
  ArmBench bench = tuned();
  bench.place(0.9, -1.4);
  bench.start();
  bench.run(1500);
  const double x_m = bench.signal("x.position_m"), z_m = bench.signal("z.position_m");
  // Only gravity pulls: in the shoulder's and the elbow's torque it is J^T K e.
  CHECK(bench.signal("z.force_N") == doctest::Approx(2000 * bench.signal("z.error_m")).epsilon(1e-3));
  CHECK(bench.signal("z.error_m") > 0);
  bench.set_point("x_m", bench.signal("x.reference_m") + 0.1, 0.5);
  bench.set_point("z_m", bench.signal("z.reference_m") + 0.05, 0.5);
  bench.run(1500);
  CHECK(bench.signal("x.position_m") - x_m == doctest::Approx(0.1).epsilon(0.05));
  CHECK(bench.signal("z.position_m") - z_m == doctest::Approx(0.05).epsilon(0.05));
}

TEST_CASE("TaskImpedance takes over, and takes a new point, without a step in torque") {
  for (const double velocity_rad_s : {0.0, 1.0}) {
    ArmBench bench = tuned();
    bench.place(0.9, -1.4);
    bench.joints.joints[0].velocity_rad_s = velocity_rad_s;
    bench.start();
    CHECK(kadans::test::largest_step(bench, 300) < 0.02);
    bench.set("point_z_m", -0.2);
    CHECK(kadans::test::largest_step(bench, 300) < 0.02);
  }
}

TEST_CASE("TaskImpedance takes a point that is set between its start and its first step without a step in torque") {
  ArmBench bench = tuned();
  bench.place(0.9, -1.4);
  bench.start();
  bench.run(300);
  bench.set("point_z_m", -0.25);
  bench.run(300);
  bench.place(0.4, -0.9);  // another object had the arm meanwhile
  bench.start();
  bench.set("point_z_m", -0.2);
  CHECK(kadans::test::largest_step(bench, 1) < 0.02);
  CHECK(bench.signal("z.error_m") == 0);
  CHECK(kadans::test::largest_step(bench, 300) < 0.02);
}

TEST_CASE("TaskImpedance keeps a set-point that comes with a new point, whichever of the two comes first") {
  for (const bool started : {false, true}) {
    ArmBench bench = tuned();
    bench.place(0.9, -1.4);
    bench.start();
    if (!started) bench.run(300);
    SetpointState x, z;
    REQUIRE(bench.object->setpoint_state(0, x));
    bench.object->follow(0, {.value = x.value + 0.1});  // as the engine does in one transaction with the parameter
    bench.set("point_z_m", -0.2);
    CHECK(kadans::test::largest_step(bench, 1) < 0.02);
    CHECK(bench.signal("x.reference_m") == x.value + 0.1);
    REQUIRE(bench.object->setpoint_state(2, z));
    CHECK(z.value == bench.signal("z.position_m"));  // what was not asked for is taken over
    CHECK(kadans::test::largest_step(bench, 300) < 0.05);
    CHECK(bench.signal("x.reference_m") == x.value + 0.1);
  }
}

TEST_CASE("TaskImpedance limits the force at the point and the torque of each joint, and says so") {
  ArmBench bench = tuned();
  bench.place(0.9, -1.4);
  bench.set("force_max_N", 30);
  bench.set("elbow.effort_max_Nm", 0.5);
  bench.start();
  bench.run(1);
  bench.set_point("x_m", 0.6, 0);
  bench.run(2);
  CHECK(std::hypot(bench.signal("x.force_N"), bench.signal("y.force_N"), bench.signal("z.force_N")) ==
        doctest::Approx(30));
  CHECK(bench.signal("force_limited") == 1);
  CHECK(std::abs(bench.effort_Nm(1)) == 0.5);
  CHECK(bench.signal("elbow.saturated") == 1);
}

TEST_CASE("TaskImpedance does not hide a joint that is not measured, and pulls no more until it is") {
  ArmBench bench = tuned();
  bench.set("elbow.damping_Nms_per_rad", 1);
  bench.place(0.9, -1.4);
  bench.start();
  bench.run(500);
  const double before_rad = bench.position_rad(0);
  bench.joints.joints[0].position_rad = std::numeric_limits<double>::quiet_NaN();
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isnan(bench.effort_Nm(0)));
  CHECK(std::isfinite(bench.effort_Nm(1)));
  CHECK(bench.signal("z.force_N") == 0);
  bench.joints.joints[0].position_rad = before_rad;
  bench.object->step(bench.input(), bench.computed);
  CHECK(std::isfinite(bench.effort_Nm(0)));
  CHECK(bench.signal("z.error_m") == 0);
}

TEST_CASE("TaskImpedance refuses what cannot work, by name") {
  CHECK(refusal({}, {0, 1}) == "it needs the option 'link': the link at the limb's end");
  CHECK(refusal({{{"link", "for"}}}, {0, 1}) == "there is no link 'for', did you mean 'fore'?");
  CHECK(refusal({{{"link", "upper"}}}, {0, 1}) == "joint elbow does not move link upper");
  CHECK(refusal({{{"link", "base"}}}, {0}) == "link base is the base: no joint moves it");
  CHECK(refusal({{{"link", "fore"}}}, {0, 1}) == "accepted");
}

TEST_CASE("TaskImpedance allocates nothing") {
  ArmBench bench = tuned();
  const kadans::testing::AllocationCount heap;
  bench.start();
  bench.object->step(bench.input(), bench.computed);
  bench.object->follow(0, {.value = 0.1, .velocity = 0.2});
  bench.object->step(bench.input(), bench.computed);
  const auto allocations = heap.count();
  CHECK(allocations == 0);
}
