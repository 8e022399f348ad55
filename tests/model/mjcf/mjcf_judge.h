// libmujoco as the judge of what an MJCF means: mass matrices, forces, accelerations and Jacobians at random states.
#pragma once

#include <string>

#include "kadans/model/mjcf.h"

namespace kadans::test {

struct JudgedRobot {
  bool judged = false;      // libmujoco takes the file, and both know the same joints
  std::string why;          // else
  double mass_matrix = 0;   // largest difference, relative to the largest entry of the matrix
  double bias = 0;          // the same of the forces at rest and in motion
  double acceleration = 0;  // of the robot left to itself: relative to the largest
  double jacobian = 0;      // of all links, relative
  double mass = 0;          // of the robot, relative
};

// Compares every row of the base, when it floats, and of the joints.
JudgedRobot judge(const std::string& file, int states, const UrdfOptions& options = {});

}  // namespace kadans::test
