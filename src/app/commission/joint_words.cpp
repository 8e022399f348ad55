// What the model says about joints, for people.
#include <array>
#include <cmath>
#include <cstdio>

#include <Eigen/LU>

#include "commission_steps.h"
#include "kadans/model/dynamics.h"
#include "kadans/model/kinematics.h"

namespace kadans {

std::vector<double> inertias_kg_m2(const RobotConfig& robot) {
  const std::size_t count = robot.model.joints.size();
  Dynamics::Config config;
  for (const DriveSettings& drive : robot.plant.drives) config.rotor_inertia_kg_m2.push_back(drive.rotor_inertia_kg_m2);
  config.rotor_inertia_kg_m2.resize(count);
  Dynamics dynamics(robot.model, config);
  const std::vector<double> zero(count);
  dynamics.update(zero, zero, {});
  const Eigen::MatrixXd free = dynamics.mass_matrix().inverse();
  std::vector<double> inertia_kg_m2(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    inertia_kg_m2[i] = 1 / free(k, k);
  }
  return inertia_kg_m2;
}

std::string positive_turn(const RobotModel& model, std::size_t joint) {
  Quat turned = model.joints[joint].origin.orientation;
  for (std::size_t link = model.joints[joint].parent; link > 0; link = model.joints[link - 1].parent)
    turned = multiply(model.joints[link - 1].origin.orientation, turned);
  const Vec3 axis = rotate(turned, model.joints[joint].axis);
  struct View {
    Vec3 from;
    const char* words;
  };
  constexpr std::array<View, 6> views{{{{0, 0, 1}, "above"},
                                       {{0, 0, -1}, "below"},
                                       {{1, 0, 0}, "before it"},
                                       {{-1, 0, 0}, "behind it"},
                                       {{0, 1, 0}, "its left"},
                                       {{0, -1, 0}, "its right"}}};
  const View* nearest = views.data();
  double most = -1;
  for (const View& view : views) {
    const double share = view.from[0] * axis[0] + view.from[1] * axis[1] + view.from[2] * axis[2];
    if (share > most + 1e-9) most = share, nearest = &view;
  }
  if (model.joints[joint].type == JointType::prismatic)
    return std::string("towards what is seen from ") + nearest->words;
  return std::string("counter-clockwise, seen from ") + nearest->words;
}

std::string degrees_text(double rad) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f degrees", std::abs(rad) * 57.29577951308232);
  return text;
}

}  // namespace kadans
