// The whole-body object on an arm that its own dynamics move, and on a biped whose joints follow exactly.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "arm_bench.h"
#include "control/made_objects.h"
#include "control/walk/leg_robot.h"

namespace kadans::test {

// The arm with its wheel as the right hand; gains that a stiff joint has.
struct HandBench : ArmBench {
  explicit HandBench(std::map<std::string, std::string> options = {{"right_hand", "wheel"}})
      : ArmBench(make_whole_body, ObjectOptions(std::move(options))) {
    for (const std::string joint : {"shoulder", "elbow"}) {
      set(joint + ".stiffness_Nm_per_rad", 200);
      set(joint + ".damping_Nms_per_rad", 5);
    }
    place(0.3, -0.8);
  }
  Vec3 hand_m() const {
    const double a = joints.joints[0].position_rad, b = a + joints.joints[1].position_rad;
    return {-0.3 * (std::sin(a) + std::sin(b)), 0, -0.3 * (std::cos(a) + std::cos(b))};
  }
};

// A biped with crouched legs, flat on the floor; each joint is where it is led.
class StandBench : public TestedObject {
 public:
  explicit StandBench(RobotModel robot = leg_robot(), std::map<std::string, std::string> options = {})
      : model(std::move(robot)), object(make_whole_body(setup(std::move(options)))) {
    declare(*object, 10);
    set("sole_m", 0);
    for (std::size_t i = 0; i < 10; ++i)
      joints.joints[i] = {.position_rad = std::array{0.0, 0.0, -0.3, 0.6, -0.3}[i % 5]};
    object->start(input());
    tick();
  }
  void tick() {
    control_tick();
    for (std::size_t i = 0; i < 10; ++i) {
      if (model.joints[i].passive()) continue;
      const std::string joint = model.joints[i].name;
      joints.joints[i].position_rad = signal(joint + ".reference_rad");
      joints.joints[i].velocity_rad_s = signal(joint + ".reference_velocity_rad_s");
      most_Nm = std::max(most_Nm, std::abs(computed.joints[i].effort_Nm));
    }
    snapshot.setpoint_count = static_cast<std::uint32_t>(catalog.setpoints.size());
    for (SetpointId id = 0; id < catalog.setpoints.size(); ++id) {
      SetpointState at;
      (void)object->setpoint_state(catalog.setpoints[id].channel, at);
      snapshot.setpoints[id] = {at.value, at.velocity};
    }
    time_ns += 1'000'000;
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  SetpointId id(const std::string& name) const {
    const auto id = catalog.setpoints.find("it." + name);
    REQUIRE_MESSAGE(id, name);
    return *id;
  }
  void move(const std::string& name, double value, double time_s) {
    TestedObject::set_point(catalog.setpoints[id(name)].channel, value, time_s);
  }
  double setpoint(const std::string& name) const { return snapshot.setpoints[id(name)].value; }
  Foresight::Miss foresee(const std::string& name, double value, double time_s = 3) {
    const Foresight::Goal goal{catalog.setpoints[id(name)].channel, value};
    snapshot.joints = joints;
    return object->foresight()->miss({{&goal, 1}, time_s}, snapshot);
  }

  RobotModel model;
  std::unique_ptr<ControlObject> object;
  double most_Nm = 0;

 private:
  ObjectSetup setup(std::map<std::string, std::string> options) const {
    options.insert({{"left_foot", "l_foot"}, {"right_foot", "r_foot"}});
    std::vector<std::size_t> driven;
    for (std::size_t i = 0; i < model.joints.size(); ++i) {
      if (!model.joints[i].passive()) driven.push_back(i);
    }
    return {model, driven, std::move(options)};
  }
};

}  // namespace kadans::test
