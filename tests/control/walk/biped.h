// A biped in the sagittal plane for tests of balance: a torso of 10 kg, two legs with feet without mass; and a bench
// for an object that balances it.
#pragma once

#include <utility>

#include "control/tested_object.h"
#include "kadans/control/object_options.h"
#include "kadans/model/robot_model.h"

namespace kadans::test {

inline Link biped_link(const char* name, double mass_kg, double com_z_m) {
  Link link;
  link.name = name;
  link.inertia = {.mass_kg = mass_kg, .com_m = {0, 0, com_z_m}, .xx = 0.1, .yy = 0.1, .zz = 0.1};
  return link;
}

inline Joint biped_joint(const char* name, std::size_t parent, const Vec3& origin_m, const Vec3& axis = {0, 1, 0}) {
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.origin.position_m = origin_m;
  joint.axis = axis;
  joint.lower_rad = -2;
  joint.upper_rad = 2;
  joint.effort_max_Nm = 20;
  joint.velocity_max_rad_s = 8;
  return joint;
}

// Straight legs of 0.5 m and 1 kg, 0.2 m apart.
inline RobotModel biped() {
  RobotModel model;
  model.links = {biped_link("torso", 10, 0), biped_link("l_leg", 1, -0.25), biped_link("l_foot", 0, 0),
                 biped_link("r_leg", 1, -0.25), biped_link("r_foot", 0, 0)};
  model.joints = {biped_joint("l_hip_pitch", 0, {0, 0.1, -0.2}), biped_joint("l_ankle_pitch", 1, {0, 0, -0.5}),
                  biped_joint("r_hip_pitch", 0, {0, -0.1, -0.2}), biped_joint("r_ankle_pitch", 3, {0, 0, -0.5})};
  return model;
}

inline const ObjectOptions biped_feet{{{"left_foot", "l_foot"}, {"right_foot", "r_foot"}}};
inline constexpr double biped_weight_N = 9.81 * 12;
inline constexpr double biped_com_height_m = (10 * 0.7 + 2 * 0.25) / 12;  // over the ankles

// The robot is where a test puts it: what the object computes moves nothing.
template <class Object>
class BalanceBench : public TestedObject {
 public:
  explicit BalanceBench(RobotModel robot = biped()) : model(std::move(robot)) { declare(object, 4); }

  void step() { object.step(input(), computed); }
  void settle() {
    object.start(input());
    for (int i = 0; i < 300; ++i) step();
  }
  // Rigid, leaning, and turning that way.
  void lean(double pitch_rad, double roll_rad = 0, double rate_rad_s = 0) {
    status.base.pitch_rad = pitch_rad;
    status.base.roll_rad = roll_rad;
    status.base.angular_velocity_rad_s = {0, rate_rad_s, 0};
    settle();
  }
  const typename Object::State& state() const { return object.state(); }
  double hip_Nm() const { return effort_Nm(0); }
  double ankle_Nm(std::size_t joint = 1) const { return effort_Nm(joint); }

  RobotModel model;
  Object object{{.model = model, .joints = {0, 1, 2, 3}, .options = biped_feet}};
};

}  // namespace kadans::test
