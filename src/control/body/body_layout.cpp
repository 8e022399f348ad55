#include "body_layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "control/option_link.h"
#include "kadans/model/kinematics.h"

namespace kadans {
namespace {

std::optional<std::size_t> link_of(const ObjectSetup& setup, const char* option) {
  const std::string* const name = setup.options.find(option);
  if (name == nullptr) return std::nullopt;
  return link_named(setup, option, *name);
}

// With all joints at zero, as the model stands.
BodyLayout::Sole sole_of(const RobotModel& model, std::size_t foot) {
  Kinematics kinematics(model);
  kinematics.update(std::vector<double>(model.joints.size(), 0.0));
  for (std::size_t i = foot; i > 0; i = model.joints[i - 1].parent) {
    if (!model.joints[i - 1].passive()) continue;
    const Vec3 axis = rotate(kinematics.link(i).orientation, model.joints[i - 1].axis);
    return {i - 1, std::abs(axis[1]) > 0.5, std::abs(axis[0]) > 0.5};
  }
  return {};
}

}  // namespace

BodyLayout::BodyLayout(const ObjectSetup& setup) : model(&setup.model), joints(joint_axes(setup)) {
  const auto add = [&](BodyTask::Kind kind, const char* name, std::size_t link) {
    tasks.push_back({kind, name, link, joint_channel});
    joint_channel += tasks.back().channels();
  };
  using enum BodyTask::Kind;
  const auto left = link_of(setup, "left_foot"), right = link_of(setup, "right_foot");
  if (left.has_value() != right.has_value())
    throw OptionError(left ? "left_foot" : "right_foot", "a robot that stands needs left_foot and right_foot");
  floating = left.has_value();
  if (floating) {
    add(com, "com", 0);
    feet = {tasks.size(), tasks.size() + 1};
    add(foot, "foot_left", *left);
    add(foot, "foot_right", *right);
    soles = {sole_of(*model, *left), sole_of(*model, *right)};
  }
  if (const auto link = link_of(setup, "trunk"); link || floating) add(trunk, "trunk", link.value_or(0));
  if (const auto link = link_of(setup, "left_hand")) add(hand, "hand_left", *link);
  if (const auto link = link_of(setup, "right_hand")) add(hand, "hand_right", *link);
  if (const auto link = link_of(setup, "gaze")) add(gaze, "gaze", *link);
  contact_channel = joint_channel;
  lead_channel = contact_channel + static_cast<std::uint32_t>(feet.size());
  joint_channel = lead_channel + 1;
  for (std::size_t i = 0; i < setup.model.joints.size(); ++i) {
    if (std::ranges::find(joints, i, &JointAxis::joint) != joints.end()) continue;
    (setup.model.joints[i].passive() ? passive : locked).push_back(i);
  }
  rotor_inertia_kg_m2.assign(setup.model.joints.size(), 0);
  for (std::size_t i = 0; i < setup.drives.size(); ++i) rotor_inertia_kg_m2[i] = setup.drives[i].rotor_inertia_kg_m2;
}

}  // namespace kadans
