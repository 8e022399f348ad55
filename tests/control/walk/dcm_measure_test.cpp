// Velocities of MovingBody against differences of positions.
#include "control/balance/dcm_measure.h"

#include <cmath>

#include <doctest/doctest.h>

#include "biped.h"
#include "kadans/signal/random.h"

namespace dcm_measure_test {

using namespace kadans;

namespace {

constexpr double moment_s = 1e-6;

// A biped whose right ankle slides, with axes that lie anyhow.
RobotModel skewed_biped() {
  RobotModel model = test::biped();
  model.joints[0].axis = {0.6, 0.0, 0.8};
  model.joints[1].axis = {0.0, 0.8, 0.6};
  model.joints[3].type = JointType::prismatic;
  for (Link& link : model.links) link.inertia.com_m = {0.03, -0.02, link.inertia.com_m[2]};
  return model;
}

struct Motion {
  explicit Motion(std::uint64_t seed) {
    RandomStream random(seed, "motion");
    for (JointState& joint : joints.joints) joint = {random.uniform(-1, 1), random.uniform(-3, 3)};
    for (double& rate : status.base.angular_velocity_rad_s) rate = random.uniform(-2, 2);
    upright = from_roll_pitch_yaw(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3));
  }
  // All of it, so much later.
  Motion later(double time_s) const {
    Motion moved = *this;
    for (JointState& joint : moved.joints.joints) joint.position_rad += time_s * joint.velocity_rad_s;
    const Vec3& w = status.base.angular_velocity_rad_s;
    moved.upright = normalized(multiply(upright, {1, time_s * w[0] / 2, time_s * w[1] / 2, time_s * w[2] / 2}));
    return moved;
  }
  MovingBody of(const RobotModel& model) const {
    MovingBody body(model);
    body.update({joints, status, last, 0, 0.001}, upright);
    return body;
  }

  JointStates joints;
  RobotStatus status;
  ActuationFrame last;
  Quat upright;
};

void check_near(const Vec3& velocity_m_s, const Vec3& before_m, const Vec3& after_m) {
  for (std::size_t k = 0; k < 3; ++k)
    REQUIRE(velocity_m_s[k] == doctest::Approx((after_m[k] - before_m[k]) / (2 * moment_s)).epsilon(1e-6).scale(1));
}

}  // namespace

TEST_CASE("MovingBody knows how each link, a point of it and the centre of mass move") {
  const RobotModel model = skewed_biped();
  const Vec3 tip_m{0.1, 0.05, -0.03};
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    CAPTURE(seed);
    const Motion motion(seed);
    const MovingBody now = motion.of(model), before = motion.later(-moment_s).of(model),
                     after = motion.later(moment_s).of(model);
    check_near(now.com_velocity_m_s(), before.com_m(), after.com_m());
    for (std::size_t i = 0; i < model.links.size(); ++i) {
      const Kinematics &a = before.kinematics(), &b = after.kinematics();
      check_near(now.velocity_m_s(i), a.link(i).position_m, b.link(i).position_m);
      check_near(now.velocity_m_s(i, transform(now.kinematics().link(i), tip_m)), transform(a.link(i), tip_m),
                 transform(b.link(i), tip_m));
    }
  }
}

}  // namespace dcm_measure_test
