// The cube on a plane in three engines, each with the parameters of its own model of contact. All take steps of a
// seventh of a frame, 0.965 ms.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "toss.h"

namespace kadans::truth {

inline constexpr int steps_per_frame = 7;
inline constexpr double step_s = frame_s / steps_per_frame;

using Parameters = std::map<std::string, double>;

class Cube {
 public:
  virtual ~Cube() = default;
  virtual void start(const Toss& toss) = 0;  // as in the first frame
  virtual void step() = 0;
  virtual Pose pose() const = 0;
};

// Throw std::invalid_argument for a parameter that they do not have; what is not given has a default.
// Our plant: friction, restitution, stiffness_N_per_m (0: hard), damping_Ns_per_m of the ground.
std::unique_ptr<Cube> kadans_cube(const Parameters& parameters);
// Bullet as it comes, a rigid body and its sequential impulse solver: the same four.
std::unique_ptr<Cube> bullet_cube(const Parameters& parameters);
// MuJoCo with its elliptic cone: friction, time_constant_s and damping_ratio of its constraints, their impedance.
std::unique_ptr<Cube> mujoco_cube(const Parameters& parameters);

// All frames of a toss.
std::vector<Pose> simulate(Cube& cube, const Toss& toss);
std::vector<Errors> replay(Cube& cube, const std::vector<Toss>& tosses);

}  // namespace kadans::truth
