// What acts along one coordinate in a step: the impulse p as a function of its velocity v at the step's end
// (joint_rows.h).
#pragma once

namespace kadans::bullet {

// A joint's own coordinate q, or a sum of two joints': share q + carrier_share q_carrier, of a drive that moves both or
// of what ties them.
struct Coordinate {
  int joint = 0;  // of links in Bullet, of degrees of freedom in a Tree
  int carrier =
      -1;  // the other one, which carries it if a linear law is to act on both; -1: the joint's own coordinate
  double share = 1, carrier_share = 0;
};

struct JointLaw {
  double at_rest = 0, slope = 0;  // p = clamp(at_rest - slope v, lower, upper); or, when it is stiff,
  double lower = 0, upper = 0;
  bool stiff = false;
  double wanted_rad_s = 0;  // v = wanted, with p between lower and upper
};

}  // namespace kadans::bullet
