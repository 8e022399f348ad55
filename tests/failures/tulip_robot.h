// TULip on the ground in Bullet, from its own configuration, on the posture set.
#pragma once

#include "app/assembly/robot.h"
#include "kadans/plant/bullet/bullet_world.h"
#include "rig.h"

namespace kadans::failures {

struct TulipParts {
  TulipParts(std::uint64_t seed);
  Robot robot;
  BulletWorld sound;
  std::unique_ptr<ControlSystem> system;
};

class TulipRobot : private TulipParts, public Rig {
 public:
  explicit TulipRobot(std::uint64_t seed, const Reactions& reactions = default_reactions());

  std::size_t joint(const std::string& name) const { return model.find_joint(name).value(); }
  double height_m() const { return plant.truth().base.position_m[2]; }
  // Torque of a motor, from its current, as a share of the joint's limit; the largest of all. (What the ground loads
  // onto the springs in an impact is more.)
  double torque_share() const;
};

}  // namespace kadans::failures
