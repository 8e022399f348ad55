// Where Bullet's frames lie in ours. Bullet moves each link's centre of mass frame (principal axes, see
// principal_axes.h), the model uses link frames at the joints. This is the one place that knows both.
#pragma once

#include <memory>
#include <vector>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"

namespace kadans::bullet {

struct LinkFrame {
  btTransform com_in_link;
  btTransform link_in_com;
  btVector3 moments_kg_m2;
};

std::vector<LinkFrame> link_frames(const RobotModel& model);

// A multibody with the model's links and joints, all joints at 0, its base at the world's origin. The payloads follow
// as links on fixed joints, without mass as yet.
std::unique_ptr<btMultiBody> make_multibody(const RobotModel& model, const std::vector<LinkFrame>& frames,
                                            const PlantSettings& settings);

}  // namespace kadans::bullet
