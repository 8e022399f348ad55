// A robot of two motors and a passive joint, for tests of control objects.
#pragma once

#include "kadans/model/robot_model.h"

inline kadans::Joint test_joint(const char* name, double effort_max_Nm) {
  kadans::Joint joint;
  joint.name = name;
  joint.lower_rad = -1;
  joint.upper_rad = 2;
  joint.effort_max_Nm = effort_max_Nm;
  joint.velocity_max_rad_s = 5;
  return joint;
}

inline kadans::RobotModel two_joint_robot() {
  kadans::RobotModel model;
  model.name = "two";
  model.links.resize(4);
  model.joints = {test_joint("hip", 20), test_joint("knee", 10), test_joint("toe", 0)};
  return model;
}
