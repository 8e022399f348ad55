// What acts on one joint in a step: the impulse p as a function of the joint's velocity v at the step's end
// (joint_rows.h).
#pragma once

namespace kadans::bullet {

struct JointLaw {
  double at_rest = 0, slope = 0;  // p = clamp(at_rest - slope v, lower, upper); or, when it is stiff,
  double lower = 0, upper = 0;
  bool stiff = false;
  double wanted_rad_s = 0;  // v = wanted, with p between lower and upper
};

}  // namespace kadans::bullet
