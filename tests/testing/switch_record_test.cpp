#include "kadans/testing/switch_record.h"

#include "control/made_objects.h"
#include "kadans/testing/doctest.h"

using namespace kadans;
using namespace kadans::testing;

namespace {

// A constant effort from its start on, and another one after some ticks.
class Jumping final : public ControlObject {
 public:
  void declare(Declaration&) override {}
  void start(const ControlInput&) noexcept override { ticks_ = 0; }
  void step(const ControlInput&, ActuationFrame& actuation) noexcept override {
    actuation.joints[0] = {.effort_Nm = ++ticks_ > 250 ? 5.0 : 0.0, .mode = ActuationMode::effort};
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }

 private:
  int ticks_ = 0;
};

// Holds, in the drive's position mode, the place where it started.
class Holding final : public ControlObject {
 public:
  void declare(Declaration&) override {}
  void start(const ControlInput& input) noexcept override { position_rad_ = input.joints.joints[0].position_rad; }
  void step(const ControlInput&, ActuationFrame& actuation) noexcept override {
    actuation.joints[0] = {.position_rad = position_rad_, .mode = ActuationMode::position};
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }

 private:
  double position_rad_ = 0;
};

template <typename Object>
std::unique_ptr<ControlObject> make(const ObjectSetup&) {
  return std::make_unique<Object>();
}

JointBenchConfig loaded() {
  return {.plant = {.inertia_kg_m2 = 0.1,
                    .viscous_Nms_per_rad = 3,
                    .load_Nm = -4,
                    .torque_max_Nm = 20,
                    .position_gain_Nm_per_rad = 400,
                    .velocity_gain_Nms_per_rad = 10}};
}

void hold_with_pid(JointBench& bench) {
  bench.set("first.joint.kp_Nm_per_rad", 100);
  bench.set("first.joint.kd_Nms_per_rad", 3);
  bench.set_point(0.4);
  bench.run(2);
}

}  // namespace

TEST_CASE("From a loaded PID to the drive's position mode there is no step, and 0.2 s later it is over") {
  JointBench bench(loaded(), {{"first", make_joint_pid}, {"second", make<Holding>}});
  hold_with_pid(bench);
  const SwitchRecord record = record_switch(bench, "second");
  CHECK(record <= SwitchLimits{});
  CHECK(record.torque_Nm.front() == doctest::Approx(4).epsilon(0.01));
  CHECK(record.torque_Nm.size() == 501);
}

TEST_CASE("The record waits for the torque to arrive when the drive is slow") {
  JointBenchConfig slow = loaded();
  slow.plant.delay_ticks = 4;
  JointBench bench(slow, {{"first", make_joint_pid}, {"second", make<Jumping>}});
  hold_with_pid(bench);
  const SwitchRecord record = record_switch(bench, "second", 0.1);
  CHECK(record.torque_Nm.front() == doctest::Approx(4).epsilon(0.01));
  CHECK(record.torque_Nm[60] < 3.9);  // fading
}

TEST_CASE("A step that an encoder hides from the framework is seen, as a share of the limit") {
  JointBenchConfig coarse = loaded();
  coarse.plant.encoder_resolution_rad = 0.025;
  JointBench bench(coarse, {{"first", make_joint_pid}, {"second", make<Holding>}});
  hold_with_pid(bench);
  const SwitchRecord record = record_switch(bench, "second");
  CHECK(record.first_step_share > 0.1);  // 400 Nm/rad times what the encoder rounds away, of 20 Nm
  CHECK_FALSE(record <= SwitchLimits{});
}

TEST_CASE("A jump that comes later is in the largest step, and delays convergence") {
  JointBench bench(loaded(), {{"first", make_joint_pid}, {"second", make<Jumping>}});
  hold_with_pid(bench);
  const SwitchRecord record = record_switch(bench, "second");
  INFO(record);
  CHECK(record.first_step_share < 0.01);
  CHECK(record.largest_step_share == doctest::Approx(0.25));
  CHECK(record.converged_s == doctest::Approx(0.25).epsilon(0.01));
}
