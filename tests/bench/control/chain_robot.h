// A chain of joints, as long as wanted, in series on a bolted base: for figures by the number of joints.
#pragma once

#include <string>

#include "app/assembly/robot.h"

namespace kadans::bench {

inline RobotModel chain(std::size_t joints) {
  RobotModel model;
  model.name = "chain";
  model.links.resize(joints + 1);
  for (std::size_t i = 0; i <= joints; ++i) {
    model.links[i].name = "link_" + std::to_string(i);
    model.links[i].inertia = {.mass_kg = 1, .com_m = {0, 0, -0.05}, .xx = 0.01, .yy = 0.01, .zz = 0.005};
  }
  for (std::size_t i = 0; i < joints; ++i) {
    Joint& joint = model.joints.emplace_back();
    joint.name = "joint_" + std::to_string(i);
    joint.parent = i;
    joint.axis = {i % 2 == 0 ? 1.0 : 0.0, i % 2 == 0 ? 0.0 : 1.0, 0};
    joint.origin.position_m = {0, 0, -0.1};
    joint.lower_rad = -2;
    joint.upper_rad = 2;
    joint.velocity_max_rad_s = 20;
    joint.effort_max_Nm = 50;
  }
  return model;
}

// One object of this type on all its joints, with gains. The types are the shipped ones.
inline Robot chain_robot(std::size_t joints, const ControlObjectTypes& types, const std::string& type) {
  Robot robot{.types = types, .config = {}};
  RobotConfig& config = robot.config;
  config.file = config.name = "chain";
  config.model = chain(joints);
  config.plant.fixed_base = true;
  config.plant.drives.assign(joints, {.torque_max_Nm = 50, .rotor_inertia_kg_m2 = 0.02});
  config.plant.encoders.resize(joints);
  config.plant.position_rad.assign(joints, 0.1);
  config.safety.joints.assign(joints, {.lower_rad = -2, .upper_rad = 2, .velocity_max_rad_s = 20, .effort_max_Nm = 50});
  ObjectConfig& object = config.objects.emplace_back();
  object.name = object.type.name = type;
  for (std::size_t i = 0; i < joints; ++i) object.joints.push_back(i);
  if (type == "task_impedance") object.options.push_back({"link", "link_" + std::to_string(joints), {}, {}});
  config.sets.push_back({.name = type, .objects = {0}});
  return robot;
}

}  // namespace kadans::bench
