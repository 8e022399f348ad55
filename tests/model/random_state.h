// Robots and states without symmetry, for tests of dynamics.
#pragma once

#include <string_view>
#include <vector>

#include "kadans/model/dynamics.h"
#include "kadans/signal/random.h"

namespace kadans::test {

// A branched tree of eight links, skew axes, full inertia tensors, two of the joints sliding.
RobotModel skew_tree();
// The same, where two of the links have no mass: one between two joints, one that carries two others.
RobotModel bare_tree();
RobotModel tulip();

struct State {
  std::vector<double> position_rad, velocity_rad_s;
  Dynamics::BaseState base;
};
// Anywhere, turned and moving anyhow.
State random_state(const RobotModel& model, RandomStream& random);
// The state a short time later, moving evenly with the generalised velocities `velocity` (six of the base first when
// there are more of them than joints).
State moved_on(const State& state, const Eigen::VectorXd& velocity, double time_s);
// The generalised velocities of the state.
Eigen::VectorXd velocities(const State& state, const Dynamics& dynamics);

}  // namespace kadans::test
