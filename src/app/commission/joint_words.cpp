// What the model says about joints, for people.
#include <array>
#include <cmath>

#include <Eigen/LU>

#include "commission_steps.h"
#include "kadans/model/dynamics.h"
#include "kadans/model/kinematics.h"
#include "signal/number_text.h"

namespace kadans {

std::vector<double> inertias_kg_m2(const RobotConfig& robot, bool by_drives) {
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
  for (const Transmission& pair : robot.model.transmissions) {
    if (!by_drives || !pair.coupled()) continue;
    const auto a = static_cast<Eigen::Index>(pair.joints()[0]), b = static_cast<Eigen::Index>(pair.joints()[1]);
    for (std::size_t drive = 0; drive < 2; ++drive) {
      const double to_a = pair.drive_per_joint(drive, 0), to_b = pair.drive_per_joint(drive, 1);
      inertia_kg_m2[pair.joints()[drive]] =
          1 / (to_a * to_a * free(a, a) + 2 * to_a * to_b * free(a, b) + to_b * to_b * free(b, b));
    }
  }
  return inertia_kg_m2;
}

namespace {

std::string turn_text(const RobotModel& model, std::size_t joint, double sign) {
  Quat turned = model.joints[joint].origin.orientation;
  for (std::size_t link = model.joints[joint].parent; link > 0; link = model.joints[link - 1].parent)
    turned = multiply(model.joints[link - 1].origin.orientation, turned);
  Vec3 axis = rotate(turned, model.joints[joint].axis);
  for (double& part : axis) part *= sign;
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

}  // namespace

std::string positive_turn_of_drive(const RobotModel& model, std::size_t joint) {
  const Transmission* const pair = model.coupling_of(joint);
  if (pair == nullptr) return turn_text(model, joint, 1);
  const std::size_t drive = pair->joints()[0] == joint ? 0 : 1;
  std::string text;
  for (std::size_t k = 0; k < 2; ++k) {
    const double way = pair->drive_per_joint(drive, k);
    if (way == 0) continue;
    text += (text.empty() ? "joint '" : " and joint '") + model.joints[pair->joints()[k]].name + "' " +
            turn_text(model, pair->joints()[k], way > 0 ? 1 : -1);
  }
  return text;
}

std::string degrees_text(double rad) { return printed("%.1f degrees", std::abs(rad) * 57.29577951308232); }

}  // namespace kadans
