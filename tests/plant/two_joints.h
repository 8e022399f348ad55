// What the two ends of a link to a plant speak of, where no physics is needed.
#pragma once

#include "kadans/model/robot_model.h"

namespace kadans::test {

inline RobotModel two_joints() {
  RobotModel model;
  model.links.resize(3);
  for (const char* name : {"hip", "knee"}) {
    Joint joint;
    joint.name = name;
    joint.lower_rad = -10;
    joint.upper_rad = 10;
    model.joints.push_back(joint);
  }
  return model;
}

}  // namespace kadans::test
