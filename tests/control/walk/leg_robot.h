// A biped as led_leg.h means it: two legs of five joints, 0.25 m thighs and 0.3 m shanks, under a torso of 10 kg.
#pragma once

#include <string>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans::test {

inline constexpr double thigh_m = 0.25, shank_m = 0.3, hip_y_m = 0.09, hip_z_m = -0.2;

inline RobotModel leg_robot() {
  RobotModel model;
  const auto link = [&](const std::string& name, double mass_kg, double com_z_m) {
    Link made;
    made.name = name;
    made.inertia = {.mass_kg = mass_kg, .com_m = {0, 0, com_z_m}, .xx = 0.01, .yy = 0.01, .zz = 0.01};
    model.links.push_back(made);
  };
  const auto joint = [&](const std::string& name, std::size_t parent, const Vec3& origin_m, const Vec3& axis) {
    Joint made;
    made.name = name;
    made.parent = parent;
    made.origin.position_m = origin_m;
    made.axis = axis;
    made.lower_rad = -2.4;
    made.upper_rad = 2.4;
    made.effort_max_Nm = 25;
    made.velocity_max_rad_s = 8;
    model.joints.push_back(made);
  };
  link("torso", 10, 0);
  for (const std::string side : {"l", "r"}) {
    const double y_m = side == "l" ? hip_y_m : -hip_y_m;
    const std::size_t first = model.links.size();
    joint(side + "_hip_yaw", 0, {0, y_m, hip_z_m}, {0, 0, 1});
    link(side + "_yaw", 0.1, 0);
    joint(side + "_hip_roll", first, {0, 0, 0}, {1, 0, 0});
    link(side + "_roll", 0.1, 0);
    joint(side + "_hip_pitch", first + 1, {0, 0, 0}, {0, 1, 0});
    link(side + "_thigh", 1, -thigh_m / 2);
    joint(side + "_knee", first + 2, {0, 0, -thigh_m}, {0, 1, 0});
    link(side + "_shank", 1, -shank_m / 2);
    joint(side + "_ankle_pitch", first + 3, {0, 0, -shank_m}, {0, 1, 0});
    link(side + "_foot", 0.3, 0);
    model.links.back().collisions.push_back(
        {.pose = {.position_m = {0.03, 0, -0.045}}, .shape = Box{{0.22, 0.1, 0.03}}});
  }
  return model;
}

}  // namespace kadans::test
