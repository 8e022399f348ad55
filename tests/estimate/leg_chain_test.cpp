#include "estimate/leg_chain.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include <doctest/doctest.h>

#include "estimate/tulip_fixture.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/random.h"

using namespace kadans;

namespace {

// The largest distance between the chain's and the whole robot's kinematics, over random poses of everything.
double worst_distance_m(const RobotModel& model, std::size_t link) {
  LegChain chain(model, link);
  Kinematics whole(model);
  RandomStream random(3, "poses");
  double worst_m = 0;
  for (int n = 0; n < 200; ++n) {
    JointStates joints;
    std::vector<double> position_rad;
    for (std::size_t i = 0; i < model.joints.size(); ++i)
      position_rad.push_back(joints.joints[i].position_rad = random.uniform(-2, 2));
    const Quat base = from_roll_pitch_yaw(random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3));
    whole.update(position_rad, {{}, base});
    chain.update(joints, axes_of(base));
    const Vec3 point_m{0.1, -0.2, 0.3};
    const Vec3 expected_m = transform(whole.link(link), point_m), seen_m = chain.point(point_m);
    worst_m =
        std::max(worst_m, std::hypot(seen_m[0] - expected_m[0], seen_m[1] - expected_m[1], seen_m[2] - expected_m[2]));
  }
  return worst_m;
}

// Joints as awkward as they come: turned origins, slanted and reversed axes, a slide.
RobotModel crooked_arm() {
  RobotModel model;
  model.links.resize(6);
  model.joints.resize(5);
  const Vec3 axes[] = {{0, 0, -1}, {0.6, 0, 0.8}, {0, -1, 0}, {2.0 / 3, -1.0 / 3, 2.0 / 3}, {-1, 0, 0}};
  for (std::size_t i = 0; i < 5; ++i) {
    Joint& joint = model.joints[i];
    joint.parent = i;
    joint.axis = axes[i];
    joint.origin.position_m = {0.1 * static_cast<double>(i), -0.05, 0.2};
    if (i % 2 == 1) joint.origin.orientation = from_roll_pitch_yaw(0.3, -0.7, 1.9);
  }
  model.joints[2].type = JointType::continuous;
  model.joints[3].type = JointType::prismatic;
  return model;
}

}  // namespace

TEST_CASE("A leg's chain puts the foot where the whole robot's kinematics puts it") {
  for (const char* link : {"l_ankle_roll_link", "r_ankle_roll_link", "l_shoulder_pitch_link", "torso"})
    CHECK(worst_distance_m(test::tulip(), test::tulip().find_link(link).value()) < 1e-12);
}

TEST_CASE("Slanted axes, turned origins and slides are followed too") {
  CHECK(worst_distance_m(crooked_arm(), 5) < 1e-12);
}

TEST_CASE("A link that the robot does not have is refused") {
  CHECK_THROWS_AS(LegChain(test::tulip(), 15), std::invalid_argument);
}
