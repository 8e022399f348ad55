// libmujoco as the judge of what an MJCF means: mass matrices and bias forces at random states.
#pragma once

#include <string>

namespace kadans::test {

struct JudgedRobot {
  bool judged = false;     // libmujoco takes the file, and both know the same joints
  std::string why;         // else
  double mass_matrix = 0;  // largest difference, relative to the largest entry of the matrix
  double bias = 0;         // the same of the forces at rest and in motion
  double mass = 0;         // of the robot, relative
};

JudgedRobot judge(const std::string& file, int states);

}  // namespace kadans::test
