#include "urdf_merge.h"

#include <limits>
#include <map>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "mesh_path.h"

namespace kadans {
namespace {

Vec3 vector(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose pose(const urdf::Pose& p) {
  const urdf::Rotation& r = p.rotation;
  return {vector(p.position), normalized({r.w, r.x, r.y, r.z})};
}

Inertia inertia(const urdf::Inertial& given) {
  Inertia own;
  own.mass_kg = given.mass;
  own.xx = given.ixx, own.yy = given.iyy, own.zz = given.izz;
  own.xy = given.ixy, own.xz = given.ixz, own.yz = given.iyz;
  return moved(own, pose(given.origin));
}

Shape shape(const urdf::Geometry& geometry, const std::string& urdf_file) {
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      return Box{vector(dynamic_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::SPHERE:
      return Sphere{dynamic_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return Cylinder{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH:
      break;
  }
  const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
  return Mesh{find_mesh(mesh.filename, urdf_file).value_or(mesh.filename), vector(mesh.scale)};
}

JointType type(const urdf::Joint& joint) {
  if (joint.type == urdf::Joint::PRISMATIC) return JointType::prismatic;
  return joint.type == urdf::Joint::CONTINUOUS ? JointType::continuous : JointType::revolute;
}

void set_limits(Joint& joint, const urdf::JointLimits* limits) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  joint.lower_rad = -infinite, joint.upper_rad = infinite, joint.velocity_max_rad_s = infinite;
  if (limits == nullptr) return;  // a continuous joint: nothing drives it, nothing holds it
  joint.effort_max_Nm = limits->effort;
  joint.velocity_max_rad_s = limits->velocity;
  if (joint.type == JointType::continuous) return;
  joint.lower_rad = limits->lower;
  joint.upper_rad = limits->upper;
}

class Merger {
 public:
  Merger(const urdf::ModelInterface& dom, const std::vector<std::string>& joint_order, const std::string& urdf_file)
      : dom_(dom), urdf_file_(urdf_file) {
    for (const std::string& name : joint_order) joints_.push_back(dom.getJoint(name));
  }

  RobotModel run() {
    model_.name = dom_.getName();
    model_.file = urdf_file_;
    add_body(*dom_.getRoot());
    while (const urdf::Joint* joint = next_joint()) add_joint(*joint);
    for (const auto& dom_joint : joints_) set_mimic(*dom_joint);
    return std::move(model_);
  }

 private:
  struct Place {
    std::size_t body = 0;
    Pose pose;  // of the URDF link in its body's frame
  };

  // The first moving joint of the document that stands on a body already there and has no body of its own.
  const urdf::Joint* next_joint() const {
    for (const auto& joint : joints_) {
      if (places_.contains(joint->parent_link_name) && !places_.contains(joint->child_link_name)) return joint.get();
    }
    return nullptr;
  }

  void add_joint(const urdf::Joint& given) {
    const Place parent = places_.at(given.parent_link_name);
    Joint joint;
    joint.name = given.name;
    joint.type = type(given);
    joint.parent = parent.body;
    joint.origin = compose(parent.pose, pose(given.parent_to_joint_origin_transform));
    const Vec3 axis = vector(given.axis);
    const Quat unit = normalized({0, axis[0], axis[1], axis[2]});
    joint.axis = {unit[1], unit[2], unit[3]};
    set_limits(joint, given.limits.get());
    if (given.dynamics) {
      joint.damping_Nms_per_rad = given.dynamics->damping;
      joint.friction_Nm = given.dynamics->friction;
    }
    model_.joints.push_back(joint);
    add_body(*dom_.getLink(given.child_link_name));
  }

  void add_body(const urdf::Link& link) {
    model_.links.emplace_back();
    model_.links.back().name = link.name;
    absorb(link, {model_.links.size() - 1, {}});
  }

  // Adds the link, and all that is fixed to it, to its body.
  void absorb(const urdf::Link& link, const Place& place) {
    places_.emplace(link.name, place);
    Link& body = model_.links[place.body];
    if (link.name != body.name) body.merged.push_back(link.name);
    if (link.inertial) body.inertia = combined(body.inertia, moved(inertia(*link.inertial), place.pose));
    for (const auto& given : link.collision_array) {
      body.collisions.push_back(geometry(given->name, link.name, place, given->origin, *given->geometry));
    }
    for (const auto& given : link.visual_array) {
      body.visuals.push_back(geometry(given->name, link.name, place, given->origin, *given->geometry));
      if (given->material) set_color(body.visuals.back(), given->material->color);
    }
    for (const auto& joint : joints_) {
      if (joint->type != urdf::Joint::FIXED || joint->parent_link_name != link.name) continue;
      absorb(*dom_.getLink(joint->child_link_name),
             {place.body, compose(place.pose, pose(joint->parent_to_joint_origin_transform))});
    }
  }

  Geometry geometry(const std::string& name, const std::string& link, const Place& place, const urdf::Pose& origin,
                    const urdf::Geometry& given) const {
    Geometry result;
    result.name = name;
    result.link = link;
    result.pose = compose(place.pose, pose(origin));
    result.shape = shape(given, urdf_file_);
    return result;
  }

  static void set_color(Geometry& geometry, const urdf::Color& c) {
    geometry.color = {static_cast<double>(c.r), static_cast<double>(c.g), static_cast<double>(c.b),
                      static_cast<double>(c.a)};
  }

  // A joint that mimics a mimic is tied to the joint that leads them both.
  void set_mimic(const urdf::Joint& given) {
    if (!given.mimic) return;
    Mimic mimic{0, given.mimic->multiplier, given.mimic->offset};
    auto leader = dom_.getJoint(given.mimic->joint_name);
    for (; leader->mimic; leader = dom_.getJoint(leader->mimic->joint_name)) {
      mimic.offset += mimic.multiplier * leader->mimic->offset;
      mimic.multiplier *= leader->mimic->multiplier;
    }
    mimic.joint = *model_.find_joint(leader->name);
    model_.joints[*model_.find_joint(given.name)].mimic = mimic;
  }

  const urdf::ModelInterface& dom_;
  const std::string& urdf_file_;
  std::vector<urdf::JointConstSharedPtr> joints_;  // in the order of the document
  std::map<std::string, Place> places_;
  RobotModel model_;
};

}  // namespace

RobotModel merge_fixed_joints(const urdf::ModelInterface& dom, const std::vector<std::string>& joint_order,
                              const std::string& urdf_file) {
  return Merger(dom, joint_order, urdf_file).run();
}

}  // namespace kadans
