#include "random_state.h"

#include <cmath>

#include "kadans/model/urdf.h"

namespace kadans::test {
namespace {

Vec3 random_vector(RandomStream& random, double largest) {
  Vec3 v{};
  for (double& part : v) part = random.uniform(-largest, largest);
  return v;
}

Vec3 unit(Vec3 v) {
  const double norm = length(v);
  for (double& part : v) part /= norm;
  return v;
}

// As of a few point masses: possible for certain.
Inertia random_inertia(RandomStream& random) {
  Inertia inertia{.mass_kg = random.uniform(0.3, 2.0), .com_m = random_vector(random, 0.1)};
  for (int i = 0; i < 4; ++i) {
    const Vec3 p = random_vector(random, 0.15);
    const double m = inertia.mass_kg / 4;
    inertia.xx += m * (p[1] * p[1] + p[2] * p[2]);
    inertia.yy += m * (p[0] * p[0] + p[2] * p[2]);
    inertia.zz += m * (p[0] * p[0] + p[1] * p[1]);
    inertia.xy -= m * p[0] * p[1];
    inertia.xz -= m * p[0] * p[2];
    inertia.yz -= m * p[1] * p[2];
  }
  return inertia;
}

}  // namespace

RobotModel skew_tree() {
  RandomStream random(7, "skew tree");
  RobotModel model;
  model.name = "skew";
  model.links.resize(8);
  for (Link& link : model.links) link.inertia = random_inertia(random);
  const std::size_t parents[] = {0, 1, 2, 0, 4, 4, 6};
  for (std::size_t i = 0; i < 7; ++i) {
    Joint joint;
    joint.name = "j" + std::to_string(i);
    joint.type = i == 1 || i == 5 ? JointType::prismatic : JointType::revolute;
    joint.parent = parents[i];
    joint.origin = {random_vector(random, 0.3), from_axis_angle(unit(random_vector(random, 1)), 1.1)};
    joint.axis = unit(random_vector(random, 1));
    joint.effort_max_Nm = 10;
    model.joints.push_back(joint);
  }
  return model;
}

RobotModel bare_tree() {
  RobotModel model = skew_tree();
  model.name = "bare";
  model.links[1].inertia = model.links[4].inertia = {};
  return model;
}

RobotModel tulip() { return read_urdf(KADANS_SOURCE_DIR "/models/tulip/tulip.urdf"); }

State random_state(const RobotModel& model, RandomStream& random) {
  State state;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    state.position_rad.push_back(random.uniform(-1, 1));
    state.velocity_rad_s.push_back(random.uniform(-3, 3));
  }
  state.base.pose.position_m = random_vector(random, 2);
  const double angle_rad = random.uniform(-3, 3);
  state.base.pose.orientation = from_axis_angle(unit(random_vector(random, 1)), angle_rad);
  state.base.velocity_m_s = random_vector(random, 1);
  state.base.angular_velocity_rad_s = random_vector(random, 2);
  return state;
}

State moved_on(const State& state, const Eigen::VectorXd& velocity, double time_s) {
  State next = state;
  const auto joints = static_cast<Eigen::Index>(state.position_rad.size());
  const Eigen::Index first = velocity.size() - joints;
  for (Eigen::Index i = 0; i < joints; ++i) {
    next.position_rad[static_cast<std::size_t>(i)] += time_s * velocity[first + i];
  }
  if (first == 0) return next;
  for (Eigen::Index k = 0; k < 3; ++k) {
    next.base.pose.position_m[static_cast<std::size_t>(k)] += time_s * velocity[k];
  }
  const Vec3 turn{velocity[3], velocity[4], velocity[5]};
  const double speed_rad_s = length(turn);
  if (speed_rad_s > 0) {
    const Quat by = from_axis_angle(unit(turn), speed_rad_s * time_s);
    next.base.pose.orientation = multiply(by, state.base.pose.orientation);
  }
  return next;
}

Eigen::VectorXd velocities(const State& state, const Dynamics& dynamics) {
  Eigen::VectorXd v(static_cast<Eigen::Index>(dynamics.size()));
  const auto first = static_cast<Eigen::Index>(dynamics.base_size());
  for (Eigen::Index k = 0; k < first / 2; ++k) {
    v[k] = state.base.velocity_m_s[static_cast<std::size_t>(k)];
    v[3 + k] = state.base.angular_velocity_rad_s[static_cast<std::size_t>(k)];
  }
  for (std::size_t i = 0; i < state.velocity_rad_s.size(); ++i) {
    v[first + static_cast<Eigen::Index>(i)] = state.velocity_rad_s[i];
  }
  return v;
}

}  // namespace kadans::test
