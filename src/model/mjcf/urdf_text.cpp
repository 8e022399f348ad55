#include "urdf_text.h"

#include <cmath>

#include "kadans/model/kinematics.h"
#include "signal/number_text.h"
#include "signal/utf8.h"

namespace kadans {
namespace {

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + html_text(value) + "\"";
}
std::string attribute(const char* name, double value) { return attribute(name, number_text(value)); }
template <std::size_t n>
std::string attribute(const char* name, const std::array<double, n>& values) {
  return attribute(name, listed(values, number_text, " "));
}

// Exact also where pitch is a quarter turn: roll is what is left when yaw and pitch are taken away.
Vec3 angles_of(const Quat& q) {
  const Vec3 x = rotate(q, {1, 0, 0});
  const double yaw = std::hypot(x[0], x[1]) > 1e-12 ? std::atan2(x[1], x[0]) : 0;
  const double pitch = std::atan2(-x[2], std::hypot(x[0], x[1]));
  const Vec3 y = rotate(q, {0, 1, 0});
  const Vec3 level{-std::sin(yaw), std::cos(yaw), 0};  // where y is without roll
  const Vec3 up{std::sin(pitch) * std::cos(yaw), std::sin(pitch) * std::sin(yaw), std::cos(pitch)};
  const auto along = [&](const Vec3& v) { return y[0] * v[0] + y[1] * v[1] + y[2] * v[2]; };
  return {std::atan2(along(up), along(level)), pitch, yaw};
}

std::string origin(const Pose& pose) {
  return "<origin" + attribute("xyz", pose.position_m) + attribute("rpy", angles_of(pose.orientation)) + "/>";
}

std::string shape_text(const Shape& shape) {
  if (const auto* box = std::get_if<Box>(&shape)) return "<box" + attribute("size", box->size_m) + "/>";
  if (const auto* sphere = std::get_if<Sphere>(&shape)) return "<sphere" + attribute("radius", sphere->radius_m) + "/>";
  if (const auto* round = std::get_if<Cylinder>(&shape))
    return "<cylinder" + attribute("radius", round->radius_m) + attribute("length", round->length_m) + "/>";
  const Mesh& mesh = std::get<Mesh>(shape);
  return "<mesh" + attribute("filename", mesh.file) + attribute("scale", mesh.scale) + "/>";
}

void add(const char* element, const Geometry& geometry, const std::string& material, std::string& text) {
  text += std::string("    <") + element + ">" + origin(geometry.pose) + "<geometry>" + shape_text(geometry.shape) +
          "</geometry>" + material + "</" + element + ">\n";
}

std::string material(const Geometry& geometry) {
  std::string name = "rgba";
  for (const double part : geometry.color) name += " " + number_text(part);
  return "<material" + attribute("name", name) + "><color" + attribute("rgba", geometry.color) + "/></material>";
}

void add(const UrdfLink& link, std::string& text) {
  text += "  <link" + attribute("name", link.name) + ">\n";
  if (link.inertia) {
    const Inertia& i = *link.inertia;
    text += "    <inertial><origin" + attribute("xyz", i.com_m) + "/><mass" + attribute("value", i.mass_kg) +
            "/><inertia" + attribute("ixx", i.xx) + attribute("ixy", i.xy) + attribute("ixz", i.xz) +
            attribute("iyy", i.yy) + attribute("iyz", i.yz) + attribute("izz", i.zz) + "/></inertial>\n";
  }
  // What collides is drawn where there is nothing else to be drawn.
  for (const UrdfGeometry& visual : link.visuals.empty() ? link.collisions : link.visuals)
    add("visual", visual.geometry, material(visual.geometry), text);
  for (const UrdfGeometry& collision : link.collisions) add("collision", collision.geometry, {}, text);
  text += "  </link>\n";
}

void add(const UrdfJoint& joint, std::string& text) {
  const Joint& j = joint.joint;
  const char* const type = !joint.moves                      ? "fixed"
                           : j.type == JointType::prismatic  ? "prismatic"
                           : j.type == JointType::continuous ? "continuous"
                                                             : "revolute";
  text += "  <joint" + attribute("name", joint.name) + attribute("type", type) + ">\n    " + origin(j.origin) +
          "<parent" + attribute("link", joint.parent.link) + "/><child" + attribute("link", joint.child.link) + "/>\n";
  if (joint.moves) {
    text += "    <axis" + attribute("xyz", j.axis) + "/><limit";
    if (j.type != JointType::continuous) {
      text += attribute("lower", std::isinf(j.lower_rad) ? -1e9 : j.lower_rad) +
              attribute("upper", std::isinf(j.upper_rad) ? 1e9 : j.upper_rad);
    }
    text += attribute("effort", j.effort_max_Nm) + attribute("velocity", j.velocity_max_rad_s) + "/>\n";
    text += "    <dynamics" + attribute("damping", j.damping_Nms_per_rad) + attribute("friction", j.friction_Nm) +
            attribute("armature", j.rotor_inertia_kg_m2) + "/>\n";
  }
  if (joint.mimic)
    text += "    <mimic" + attribute("joint", joint.mimic->joint) + attribute("multiplier", joint.mimic->multiplier) +
            attribute("offset", joint.mimic->offset) + "/>\n";
  text += "  </joint>\n";
}

}  // namespace

std::string urdf_text(const UrdfDescription& robot) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot" + attribute("name", robot.name) + ">\n";
  for (const UrdfLink& link : robot.links) add(link, text);
  for (const UrdfJoint& joint : robot.joints) add(joint, text);
  return text + "</robot>\n";
}

}  // namespace kadans
