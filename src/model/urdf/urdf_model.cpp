// From what a URDF says to a RobotModel: fixed joints disappear, what hung on them moves into the parent.
#include <algorithm>
#include <map>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/urdf.h"
#include "signal/input_file.h"
#include "urdf_description.h"

namespace kadans {
namespace {

// The description has been checked: a tree, mimics without rings.
class Merger {
 public:
  Merger(const UrdfDescription& robot, UrdfDocument& document) : robot_(robot), document_(document) {
    for (const UrdfLink& link : robot.links) links_.emplace(link.name, &link);
    for (const UrdfJoint& joint : robot.joints) {
      joints_.emplace(joint.name, &joint);
      joint_above_.emplace(joint.child.link, &joint);
    }
  }

  RobotModel run() {
    model_.name = robot_.name;
    for (const UrdfLink& link : robot_.links) {
      if (!joint_above_.contains(link.name)) add_body(link);
    }
    while (const UrdfJoint* joint = next_joint()) add_joint(*joint);
    for (const UrdfJoint& joint : robot_.joints) set_mimic(joint);
    for (const UrdfTransmission& given : robot_.transmissions) add_transmission(given);
    return std::move(model_);
  }

 private:
  struct Place {
    std::size_t body = 0;
    Pose pose;  // of the URDF link in its body's frame
  };

  // The first moving joint of the document that stands on a body already there and has no body of its own.
  const UrdfJoint* next_joint() const {
    const auto is_next = [&](const UrdfJoint& joint) {
      return places_.contains(joint.parent.link) && !places_.contains(joint.child.link);
    };
    const auto found = std::ranges::find_if(robot_.joints, is_next);
    return found == robot_.joints.end() ? nullptr : &*found;
  }

  void add_joint(const UrdfJoint& given) {
    const Place& parent = places_.at(given.parent.link);
    Joint& joint = model_.joints.emplace_back(given.joint);
    joint.parent = parent.body;
    joint.origin = compose(parent.pose, given.joint.origin);
    add_body(*links_.at(given.child.link));
  }

  // The link and all that is fixed to it: depth first, in the order of the document.
  void add_body(const UrdfLink& top) {
    const std::size_t body = model_.links.size();
    model_.links.emplace_back().name = top.name;
    std::vector<std::pair<const UrdfLink*, Pose>> open{{&top, {}}};
    while (!open.empty()) {
      const auto [link, pose] = open.back();
      open.pop_back();
      absorb(*link, {body, pose});
      for (auto joint = robot_.joints.rbegin(); joint != robot_.joints.rend(); ++joint) {
        if (joint->moves || joint->parent.link != link->name) continue;
        open.emplace_back(links_.at(joint->child.link), compose(pose, joint->joint.origin));
      }
    }
  }

  void absorb(const UrdfLink& link, const Place& place) {
    places_.emplace(link.name, place);
    Link& body = model_.links[place.body];
    if (link.name != body.name) body.merged.push_back(link.name);
    if (link.inertia) body.inertia = combined(body.inertia, moved(*link.inertia, place.pose));
    const auto add = [&](const std::vector<UrdfGeometry>& all, std::vector<Geometry>& to) {
      for (const UrdfGeometry& given : all) {
        to.push_back(given.geometry);
        to.back().pose = compose(place.pose, given.geometry.pose);
      }
    };
    add(link.collisions, body.collisions);
    add(link.visuals, body.visuals);
  }

  // A joint that mimics a mimic is tied to the joint that leads them both.
  void set_mimic(const UrdfJoint& given) {
    if (!given.mimic) return;
    Mimic mimic{0, given.mimic->multiplier, given.mimic->offset};
    const UrdfJoint* leader = joints_.at(given.mimic->joint);
    for (; leader->mimic; leader = joints_.at(leader->mimic->joint)) {
      mimic.offset += mimic.multiplier * leader->mimic->offset;
      mimic.multiplier *= leader->mimic->multiplier;
    }
    mimic.joint = *model_.find_joint(leader->name);
    Joint& joint = model_.joints[*model_.find_joint(given.name)];
    joint.mimic = mimic;
    joint.effort_max_Nm = 0;
  }

  void add_transmission(const UrdfTransmission& given) {
    Transmission::Settings settings = given.settings;
    for (const std::string& joint : given.joints) settings.joints.push_back(*model_.find_joint(joint));
    if (settings.joints.size() == 2 && !model_.on_one_path(settings.joints[0], settings.joints[1]))
      return document_.warn(given.at, "this transmission is not used: one of its two joints must carry the other");
    model_.transmissions.emplace_back(settings);
  }

  const UrdfDescription& robot_;
  UrdfDocument& document_;
  std::map<std::string, const UrdfLink*> links_;
  std::map<std::string, const UrdfJoint*> joints_, joint_above_;  // joint_above_: by child link
  std::map<std::string, Place> places_;
  RobotModel model_;
};

void tell_motors(const RobotModel& model, UrdfDocument& document) {
  if (!model.joints.empty() && std::ranges::all_of(model.joints, &Joint::passive))
    document.warn(0, "no joint of this robot has a motor: each 'effort' is 0 or missing");
}

}  // namespace

RobotModel merged(const UrdfDescription& robot, UrdfDocument& document) { return Merger(robot, document).run(); }

RobotModel read_urdf(const std::string& file, const UrdfOptions& options, std::vector<InputProblem>* warnings) {
  return read_urdf_text(read_input_file(file, description_max_bytes), file, options, warnings);
}

RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options,
                          std::vector<InputProblem>* warnings) {
  const auto fail = [&](const std::string& what) { throw InputError(InputProblem{file, 0, 0, what}); };
  if (text.empty()) fail("the file is empty");
  if (text.size() > description_max_bytes)
    fail("the file has " + std::to_string(text.size()) + " bytes, a URDF may have 2 MiB");
  UrdfDocument document(text, file);
  UrdfDescription robot = read_description(document);
  check_description(document, robot, options);
  if (file.ends_with(".URDF")) document.warn(0, "the file's name ends in .URDF: what looks for .urdf will not find it");
  document.throw_if_refused();
  RobotModel model = merged(robot, document);
  tell_motors(model, document);
  document.throw_if_refused(options.strict);
  if (warnings != nullptr) *warnings = document.warnings();
  model.file = file;
  return model;
}

std::vector<UrdfFrame> urdf_frames(const RobotModel& model, const std::string& text) {
  UrdfDocument document(text, model.file);
  UrdfDescription robot = read_description(document);
  document.throw_if_refused();
  std::ranges::sort(robot.joints, {}, &UrdfJoint::name);
  std::vector<UrdfFrame> frames;
  for (const UrdfJoint& joint : robot.joints)
    frames.push_back({joint.parent.link, joint.child.link, model.find_joint(joint.name), joint.joint.origin});
  return frames;
}

Pose frame_pose(const UrdfFrame& frame, const RobotModel& model, std::span<const double> position_rad) noexcept {
  if (!frame.joint) return frame.origin;
  return compose(frame.origin, motion_of(model.joints[*frame.joint], position_rad[*frame.joint]));
}

}  // namespace kadans
