#include "kadans/model/robot_model.h"

#include <algorithm>

#include "kadans/signal/nearest_name.h"

namespace kadans {

std::optional<std::size_t> RobotModel::find_joint(std::string_view wanted) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == wanted) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> RobotModel::find_link(std::string_view wanted) const {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const std::vector<std::string>& merged = links[i].merged;
    if (links[i].name == wanted || std::find(merged.begin(), merged.end(), wanted) != merged.end()) return i;
  }
  return std::nullopt;
}

std::vector<std::string> RobotModel::joint_names() const { return names_of(joints); }

std::vector<std::string> RobotModel::drive_names() const { return kadans::drive_names(joint_names(), transmissions); }

bool RobotModel::on_one_path(std::size_t joint, std::size_t other) const {
  std::size_t link = std::max(joint, other) + 1;  // parents come before children
  const std::size_t carrier = std::min(joint, other) + 1;
  while (link > carrier) link = joints[link - 1].parent;
  return link == carrier;
}

const Transmission* RobotModel::coupling_of(std::size_t joint) const noexcept {
  for (const Transmission& one : transmissions) {
    if (one.coupled() && std::ranges::find(one.joints(), joint) != one.joints().end()) return &one;
  }
  return nullptr;
}

void RobotModel::lead_mimics(std::span<double> position_rad) const noexcept {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (const auto& mimic = joints[i].mimic)
      position_rad[i] = mimic->multiplier * position_rad[mimic->joint] + mimic->offset;
  }
}

std::vector<std::string> RobotModel::link_names() const {
  std::vector<std::string> names;
  for (const Link& link : links) {
    names.push_back(link.name);
    names.insert(names.end(), link.merged.begin(), link.merged.end());
  }
  return names;
}

double RobotModel::mass_kg() const {
  double sum_kg = 0;
  for (const Link& link : links) sum_kg += link.inertia.mass_kg;
  return sum_kg;
}

Around box_around(const Mesh& mesh) noexcept {
  Vec3 low = mesh.corners_m.front(), high = low;
  for (const Vec3& corner : mesh.corners_m) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], corner[i]);
      high[i] = std::max(high[i], corner[i]);
    }
  }
  Around around;
  for (std::size_t i = 0; i < 3; ++i) {
    around.center_m[i] = (low[i] + high[i]) / 2;
    around.size_m[i] = high[i] - low[i];
  }
  return around;
}

ToldFault told(const Fault& fault, const RobotModel& model, std::int64_t time_ns, const std::string& robot) {
  return told(fault, fault.joint < model.joints.size() ? model.joints[fault.joint].name : "", time_ns, robot);
}

}  // namespace kadans
