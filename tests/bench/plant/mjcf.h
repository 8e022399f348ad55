// Our robot as a MuJoCo model (MJCF), so that both engines step the same thing: links, inertias, joints with their
// limits, collision shapes (meshes as the same hulls), and rigid drives as MuJoCo knows them: armature, damping,
// spring, a motor a joint. Solver, tolerance, iterations, cone and contact parameters are MuJoCo's defaults. Links
// collide with the ground and the ball, not with each other.
#pragma once

#include <string>

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"

namespace kadans::bench {

struct MjcfOptions {
  std::string solver = "Newton";     // or CG
  std::string integrator = "Euler";  // or RK4
  double time_step_s = 1e-3;
};

std::string mjcf(const RobotModel& model, const PlantSettings& settings, const MjcfOptions& options);

}  // namespace kadans::bench
