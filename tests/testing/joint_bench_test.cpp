#include "kadans/testing/joint_bench.h"

#include <limits>
#include <stdexcept>

#include <doctest/doctest.h>

#include "control/made_objects.h"
#include "kadans/testing/allocation_count.h"

using namespace kadans;
using namespace kadans::testing;

namespace {

JointBenchConfig joint() { return {.plant = {.inertia_kg_m2 = 0.05, .viscous_Nms_per_rad = 0.2, .torque_max_Nm = 20}}; }

// Writes NaN from the hundredth tick on.
class Sick final : public ControlObject {
 public:
  void declare(Declaration&) override {}
  void start(const ControlInput&) noexcept override {}
  void step(const ControlInput&, ActuationFrame& actuation) noexcept override {
    const double wrong = ++ticks_ > 100 ? std::numeric_limits<double>::quiet_NaN() : 1;
    actuation.joints[0] = {.effort_Nm = ticks_ > 150 ? 1 : wrong, .mode = ActuationMode::effort};
    actuation.joints[0].stiffness_Nm_per_rad = wrong;
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }

 private:
  int ticks_ = 0;
};

}  // namespace

TEST_CASE("A PID brings the bench's joint to its set-point") {
  JointBench bench(joint(), make_joint_pid);
  bench.set("kp_Nm_per_rad", 20);
  bench.set("kd_Nms_per_rad", 1);
  bench.set_point(0.5, 0.3);
  CHECK(bench.motion_remaining_s() == doctest::Approx(0.3));
  bench.run(2);
  CHECK(bench.position_rad() == doctest::Approx(0.5));
  CHECK(bench.signal("reference_rad") == 0.5);
  CHECK(bench.measured().position_rad == doctest::Approx(0.5));
  CHECK(bench.time_s() == doctest::Approx(2.001));
}

TEST_CASE("What is computed in a tick acts in the next") {
  JointBench bench(joint(), make_joint_pid);
  bench.set("integral_max_Nm", 0);  // or the start would take the feed-forward away
  bench.set("feedforward_Nm", 2);
  bench.tick();
  CHECK(bench.torque_Nm() == 0);
  CHECK(bench.computed().joints[0].effort_Nm == 2);
  bench.tick();
  CHECK(bench.torque_Nm() == doctest::Approx(2));
}

TEST_CASE("Names may be short, unknown and unclear ones and values out of range are refused") {
  JointBench bench(joint(), {{"soft", make_joint_pid}, {"stiff", make_joint_pid}});
  bench.set("soft.joint.kp_Nm_per_rad", 5);
  CHECK(bench.get("soft.joint.kp_Nm_per_rad") == 5);
  CHECK_THROWS_WITH_AS(bench.set("kp_Nm_per_rad", 5),
                       "parameter 'kp_Nm_per_rad' is not clear: soft.joint.kp_Nm_per_rad or stiff.joint.kp_Nm_per_rad",
                       std::invalid_argument);
  CHECK_THROWS_WITH_AS(bench.set("soft.joint.kp_Nm_per_rda", 5),
                       "unknown parameter 'soft.joint.kp_Nm_per_rda', did you mean 'soft.joint.kp_Nm_per_rad'?",
                       std::invalid_argument);
  CHECK_THROWS_AS(bench.set("soft.joint.kp_Nm_per_rad", -1), std::invalid_argument);
  CHECK_THROWS_AS(bench.set_point(4.0), std::invalid_argument);
  CHECK_THROWS_AS(bench.switch_to("hard"), std::invalid_argument);
}

TEST_CASE("The bench's objects are switched like control sets") {
  JointBench bench(joint(), {{"soft", make_joint_pid}, {"stiff", make_joint_pid}});
  bench.set("soft.joint.feedforward_Nm", 1);
  bench.set("stiff.joint.integral_max_Nm", 0);
  bench.set("stiff.joint.feedforward_Nm", 3);
  bench.run(0.01);
  bench.switch_to("stiff");
  bench.run(0.5);
  CHECK(bench.computed().joints[0].effort_Nm == doctest::Approx(3));
  bench.set_point(bench.position_rad());  // goes to the active one
  CHECK(bench.signal("stiff.joint.effort_Nm") == doctest::Approx(3));
}

TEST_CASE("What is too much or not finite is not written, and counted") {
  JointBench sick(joint(), [](const ObjectSetup&) { return std::make_unique<Sick>(); });
  sick.run(0.2);
  CHECK(sick.not_finite_ticks() == 99);
  CHECK(sick.torque_Nm() == 0);
  JointBenchConfig weak = joint();
  weak.effort_max_Nm = 0.5;
  JointBench limited(weak, [](const ObjectSetup&) { return std::make_unique<Sick>(); });
  limited.run(0.05);
  CHECK(limited.limited_ticks() == 49);
  CHECK(limited.torque_Nm() == doctest::Approx(0.5));
}

TEST_CASE("The model that the objects see is the plant: mass, lever and limits") {
  JointBenchConfig config = joint();
  config.plant.gravity_Nm = 6;
  const JointBench bench(config, make_joint_pid);
  const RobotModel& model = *bench.catalog().model;
  const Inertia& link = model.links[1].inertia;
  CHECK(link.mass_kg * -link.com_m[2] * 9.81 == doctest::Approx(6));
  CHECK(link.yy + link.mass_kg * link.com_m[2] * link.com_m[2] == doctest::Approx(0.05));
  CHECK(link.yy > 0);
  CHECK(model.joints[0].effort_max_Nm == 20);
}

TEST_CASE("A tick of the bench does not allocate") {
  JointBench bench(joint(), make_joint_pid);
  bench.tick();
  const AllocationCount heap;
  for (int i = 0; i < 100; ++i) bench.tick();
  const long allocations = heap.count();
  CHECK(allocations == 0);
}
