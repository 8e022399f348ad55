// One control object on an arm of two links that hangs in gravity, moved by its own rigid-body dynamics and ticked as
// the engines do it: what is computed in a tick is written in the next; the high level runs every tenth tick.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include "control/tested_object.h"
#include "kadans/model/dynamics.h"

namespace kadans::test {

// Shoulder and elbow about y, links of 0.3 m hanging along -z; a wheel at the end that no motor turns.
inline RobotModel arm() {
  RobotModel model;
  model.name = "arm";
  model.links.resize(4);
  const char* const names[] = {"base", "upper", "fore", "wheel"};
  for (std::size_t i = 0; i < 4; ++i) model.links[i].name = names[i];
  model.links[1].inertia = {.mass_kg = 2, .com_m = {0, 0, -0.15}, .xx = 0.02, .yy = 0.02, .zz = 0.002};
  model.links[2].inertia = {.mass_kg = 1, .com_m = {0, 0, -0.15}, .xx = 0.01, .yy = 0.01, .zz = 0.001};
  model.links[3].inertia = {.mass_kg = 0.1, .xx = 1e-4, .yy = 1e-4, .zz = 1e-4};
  model.joints.resize(3);
  const char* const joints[] = {"shoulder", "elbow", "spin"};
  for (std::size_t i = 0; i < 3; ++i) {
    Joint& joint = model.joints[i];
    joint.name = joints[i];
    joint.parent = i;
    joint.axis = {0, 1, 0};
    joint.origin.position_m = {0, 0, i == 0 ? 0.0 : -0.3};
    joint.lower_rad = -3;
    joint.upper_rad = 3;
    joint.velocity_max_rad_s = 20;
    joint.effort_max_Nm = i == 2 ? 0 : 40;
  }
  return model;
}

class ArmBench : public TestedObject {
 public:
  template <typename Make>
  explicit ArmBench(Make make, ObjectOptions options = {})
      : model(arm()), object(make(ObjectSetup{model, {0, 1}, std::move(options)})), plant_(model) {
    declare(*object, 3);
  }

  using TestedObject::set_point;
  void set_point(const std::string& name, double value, double duration_s) {
    const SetpointId id = catalog.setpoints.find("it." + name).value();
    REQUIRE(catalog.setpoints.accepts(id, value));
    TestedObject::set_point(catalog.setpoints[id].channel, value, duration_s);
  }

  void place(double shoulder_rad, double elbow_rad) {
    joints.joints[0].position_rad = shoulder_rad;
    joints.joints[1].position_rad = elbow_rad;
    carry();
  }
  // Writes what holds the arm where it is.
  void carry() {
    move(0);
    for (std::size_t i = 0; i < 2; ++i) {
      written.joints[i] = {.effort_Nm = plant_.gravity()[static_cast<Eigen::Index>(i)], .mode = ActuationMode::effort};
    }
    computed = written;
  }

  void start() noexcept { object->start(input()); }
  void tick() {
    control_tick();
    move(dt_s);
    time_ns += 1'000'000;
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  double position_rad(std::size_t joint) const { return joints.joints[joint].position_rad; }

  RobotModel model;
  std::unique_ptr<ControlObject> object;
  double load_Nm = 0;  // on the shoulder, towards larger positions

 private:
  // Semi-implicit Euler.
  void move(double time_s) {
    std::vector<double> q(3), v(3);
    for (std::size_t i = 0; i < 3; ++i) {
      q[i] = joints.joints[i].position_rad;
      v[i] = joints.joints[i].velocity_rad_s;
    }
    plant_.update(q, v, {});
    Eigen::VectorXd force = -plant_.bias();
    for (std::size_t i = 0; i < 2; ++i) force[static_cast<Eigen::Index>(i)] += written.joints[i].effort_Nm;
    force[0] += load_Nm;
    const Eigen::VectorXd acceleration = plant_.mass_matrix().llt().solve(force);
    for (std::size_t i = 0; i < 3; ++i) {
      JointState& joint = joints.joints[i];
      joint.velocity_rad_s += time_s * acceleration[static_cast<Eigen::Index>(i)];
      joint.position_rad += time_s * joint.velocity_rad_s;
    }
  }

  Dynamics plant_;
};

// The largest step of any joint's torque from one tick to the next, over so many ticks, as a share of its limit; the
// first step is from what was written before the object started.
inline double largest_step(ArmBench& bench, int ticks) {
  double largest = 0;
  for (int i = 0; i < ticks; ++i) {
    const double before[] = {bench.effort_Nm(0), bench.effort_Nm(1)};
    bench.tick();
    for (std::size_t j = 0; j < 2; ++j) largest = std::max(largest, std::abs(bench.effort_Nm(j) - before[j]) / 40);
  }
  return largest;
}

}  // namespace kadans::test
