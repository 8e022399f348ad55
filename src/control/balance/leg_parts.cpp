#include "leg_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

constexpr double along_axis = 0.95;  // cosine: within 18 degrees

struct Turn {
  std::size_t axis = 0;  // 0 x, 1 y, 2 z
  double sign = 1;
};

// By joint; nothing for one about an axis aslant.
std::vector<std::optional<Turn>> turns_of(const RobotModel& model) {
  Kinematics kinematics(model);
  const std::vector<double> zero(model.joints.size(), 0.0);
  kinematics.update(zero);
  std::vector<std::optional<Turn>> turns(model.joints.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (model.joints[i].type == JointType::prismatic) continue;
    const Vec3 axis = rotate(kinematics.link(i + 1).orientation, model.joints[i].axis);
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::abs(axis[k]) >= along_axis) turns[i] = {.axis = k, .sign = axis[k] > 0 ? 1.0 : -1.0};
    }
  }
  return turns;
}

// The joints from the base to the foot.
std::vector<std::size_t> chain_to(const RobotModel& model, std::size_t foot) {
  std::vector<std::size_t> chain;
  for (std::size_t link = foot; link != 0; link = model.joints[link - 1].parent) chain.push_back(link - 1);
  std::ranges::reverse(chain);
  return chain;
}

}  // namespace

std::vector<JointPart> leg_parts(const RobotModel& model, std::span<const std::size_t> feet) {
  const auto turns = turns_of(model);
  std::vector<JointPart> parts(model.joints.size());
  std::vector<bool> in_leg(model.joints.size(), false);
  for (std::size_t leg = 0; leg < feet.size(); ++leg) {
    std::array<std::vector<std::size_t>, 3> about;
    for (const std::size_t joint : chain_to(model, feet[leg])) {
      in_leg[joint] = true;
      if (turns[joint]) about[turns[joint]->axis].push_back(joint);
    }
    const auto take = [&](std::size_t joint, LegPart part) { parts[joint] = {part, turns[joint]->sign, leg}; };
    const auto& [rolls, pitches, yaws] = about;
    if (!yaws.empty()) take(yaws.front(), LegPart::hip_yaw);
    for (const std::size_t joint : pitches) take(joint, LegPart::knee);
    if (!pitches.empty()) take(pitches.front(), LegPart::hip_pitch);
    if (pitches.size() > 1) take(pitches.back(), LegPart::ankle_pitch);
    if (!rolls.empty()) take(rolls.front(), LegPart::hip_roll);
    if (rolls.size() > 1) take(rolls.back(), LegPart::ankle_roll);
  }
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (!in_leg[i] && turns[i] && turns[i]->axis == 1) parts[i] = {LegPart::swing, turns[i]->sign, 0};
  }
  return parts;
}

}  // namespace kadans
