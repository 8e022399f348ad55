// One control object on the hip and the knee of two_joint_robot, ticked as the control engine does it: what is computed
// in a tick is written in the next. The joints are inertias of their own under a constant load; their drives have
// position and velocity modes with gains, implicit as a fast inner loop is.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include <doctest/doctest.h>

#include "tested_object.h"
#include "two_joint_robot.h"

namespace kadans::test {

class ObjectBench : public TestedObject {
 public:
  static constexpr double inertia_kg_m2 = 0.05;
  static constexpr double position_gain_Nm_per_rad = 400, velocity_gain_Nms_per_rad = 8;
  static constexpr double load_Nm = 3;  // pulls towards smaller positions

  template <typename Make>
  explicit ObjectBench(Make make) : model(two_joint_robot()), object(make(ObjectSetup{model, {0, 1}})) {
    declare(*object, 3);
  }

  void set_if_there(const std::string& parameter, double value) {
    if (catalog.parameters.find("it." + parameter)) set(parameter, value);
  }
  using TestedObject::set_point;
  void set_point(const std::string& name, double value, double duration_s) {
    TestedObject::set_point(channel(name), value, duration_s);
  }
  void cancel(const std::string& name) { cancel_motion(channel(name)); }
  void start() const noexcept { object->start(input()); }
  void compute() noexcept {
    lead();
    object->step(input(), computed);
  }

  // One tick of the engine and the plant.
  void tick() noexcept {
    written = computed;
    compute();
    for (std::size_t i = 0; i < 2; ++i) move(joints.joints[i], written.joints[i]);
  }
  void run(int ticks) noexcept {
    for (int i = 0; i < ticks; ++i) tick();
  }
  const JointState& hip() const noexcept { return joints.joints[0]; }

  // The torque of the drive is left in the joint's measured effort.
  static void move(JointState& joint, const JointActuation& asked) noexcept {
    const bool by_asked = asked.mode == ActuationMode::impedance;
    const bool has_damping = asked.mode != ActuationMode::effort && asked.mode != ActuationMode::off;
    const double own_kp = asked.mode == ActuationMode::position ? position_gain_Nm_per_rad : 0;
    const double own_kd = has_damping ? velocity_gain_Nms_per_rad : 0;
    const double kp = by_asked ? asked.stiffness_Nm_per_rad : own_kp;
    const double kd = by_asked ? asked.damping_Nms_per_rad : own_kd;
    const double effort_Nm = asked.mode == ActuationMode::off ? 0 : asked.effort_Nm;
    const double pull_Nm = kp * (asked.position_rad - joint.position_rad) + kd * asked.velocity_rad_s + effort_Nm;
    const double before_rad_s = joint.velocity_rad_s;
    joint.velocity_rad_s =
        (inertia_kg_m2 * before_rad_s + dt_s * (pull_Nm - load_Nm)) / (inertia_kg_m2 + dt_s * (kd + dt_s * kp));
    joint.effort_Nm = inertia_kg_m2 * (joint.velocity_rad_s - before_rad_s) / dt_s + load_Nm;
    joint.position_rad += dt_s * joint.velocity_rad_s;
  }

  RobotModel model;
  std::unique_ptr<ControlObject> object;

 private:
  std::uint32_t channel(const std::string& name) const {
    const auto id = catalog.setpoints.find("it." + name);
    REQUIRE(id);
    return catalog.setpoints[*id].channel;
  }
};

}  // namespace kadans::test
