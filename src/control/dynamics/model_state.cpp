#include "kadans/control/model_state.h"

#include <cmath>

namespace kadans {
namespace {

bool finite(const BaseStatus& base) noexcept {
  bool all = true;
  for (const double part : base.orientation) all = all && std::isfinite(part);
  for (const double part : base.angular_velocity_rad_s) all = all && std::isfinite(part);
  return all;
}

}  // namespace

ModelState::ModelState(const RobotModel& model)
    : led_(model.joints.size()),
      position_rad_(model.joints.size(), 0.0),
      velocity_rad_s_(model.joints.size(), 0.0),
      dynamics_(model) {
  for (std::size_t i = 0; i < led_.size(); ++i) {
    led_[i].push_back({static_cast<Eigen::Index>(i), 1});
    if (const auto& mimic = model.joints[i].mimic)
      led_[mimic->joint].push_back({static_cast<Eigen::Index>(i), mimic->multiplier});
  }
}

double ModelState::effort_of(const Eigen::VectorXd& efforts, std::size_t joint) const noexcept {
  double sum = 0;
  for (const Led& led : led_[joint]) sum += led.multiplier * efforts[led.joint];
  return sum;
}

double ModelState::entry_of(const Eigen::MatrixXd& matrix, std::size_t joint, std::size_t moved) const noexcept {
  double sum = 0;
  for (const Led& row : led_[joint]) {
    for (const Led& column : led_[moved]) sum += row.multiplier * column.multiplier * matrix(row.joint, column.joint);
  }
  return sum;
}

bool ModelState::update(const Snapshot& snapshot, double ahead_s) noexcept {
  const BaseStatus& base = snapshot.status.base;
  if (!finite(base)) return false;
  for (std::size_t i = 0; i < position_rad_.size(); ++i) {
    const JointState& joint = snapshot.joints.joints[i];
    if (!(std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s))) return false;
  }
  for (std::size_t i = 0; i < position_rad_.size(); ++i) {
    velocity_rad_s_[i] = snapshot.joints.joints[i].velocity_rad_s;
    position_rad_[i] = snapshot.joints.joints[i].position_rad + ahead_s * velocity_rad_s_[i];
  }
  Dynamics::BaseState state;
  state.pose.orientation = base.orientation;
  state.angular_velocity_rad_s = rotate(base.orientation, base.angular_velocity_rad_s);
  dynamics_.update(position_rad_, velocity_rad_s_, state);
  return true;
}

}  // namespace kadans
