// URDF's elements, one function each: which attributes and children they have, and what these may not be.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/capacity.h"
#include "signal/nearest_name.h"
#include "urdf_description.h"
#include "urdf_document.h"

namespace kadans {
namespace {

constexpr std::size_t most_read = 1000;  // of links and of joints, fixed ones included

// Rz(yaw) Ry(pitch) Rx(roll), in the operations of liburdfdom 3.0, which read URDF before, and normalized twice as it
// was then: another order has other last digits, and every state hash would be another.
Quat rotation_of(const Vec3& rpy) {
  const double phi = rpy[0] / 2.0, the = rpy[1] / 2.0, psi = rpy[2] / 2.0;
  const double x = std::sin(phi) * std::cos(the) * std::cos(psi) - std::cos(phi) * std::sin(the) * std::sin(psi);
  const double y = std::cos(phi) * std::sin(the) * std::cos(psi) + std::sin(phi) * std::cos(the) * std::sin(psi);
  const double z = std::cos(phi) * std::cos(the) * std::sin(psi) - std::sin(phi) * std::sin(the) * std::cos(psi);
  const double w = std::cos(phi) * std::cos(the) * std::cos(psi) + std::sin(phi) * std::sin(the) * std::sin(psi);
  const double norm = std::sqrt(x * x + y * y + z * z + w * w);
  return normalized({w / norm, x / norm, y / norm, z / norm});
}

void find_xacro(UrdfDocument& document, const tinyxml2::XMLElement& element) {
  const std::string advice = ": this is xacro, expand it first (xacro FILE.xacro > FILE.urdf)";
  const auto is_xacro = [](const tinyxml2::XMLElement& e) { return std::string_view(e.Name()).starts_with("xacro:"); };
  const UrdfElement e(document, element);
  if (is_xacro(element)) document.refuse(e.at(), e.shown_name() + advice);
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view name = a->Name(), value = a->Value();
    if (name == "xmlns:xacro") {
      document.refuse(e.at_name(name), "xmlns:xacro" + advice + "; if it is expanded, remove this attribute");
    } else if (value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos) {
      document.refuse(e.at_value(name), "'" + shown(value) + "'" + advice);
    }
  }
  for (const auto* child = element.FirstChildElement(); child != nullptr; child = child->NextSiblingElement()) {
    const std::string_view name = child->Name();
    const bool of_urdf = &element != &document.root() || name == "link" || name == "joint" || name == "material";
    if (of_urdf || is_xacro(*child)) find_xacro(document, *child);
  }
}

class UrdfReader {
 public:
  explicit UrdfReader(UrdfDocument& document) : document_(document) {}

  UrdfDescription run() {
    find_xacro(document_, document_.root());
    document_.throw_if_refused();
    const UrdfElement root(document_, document_.root());
    if (root.shown_name() != "<robot>")
      document_.stop(root.at(), "the root element is " + root.shown_name() + ", a URDF's is <robot>");
    robot(root);
    if (robot_.links.empty()) document_.stop(root.at(), "this robot has no <link>");
    paint();
    return std::move(robot_);
  }

 private:
  using enum UrdfValue;
  using enum UrdfCount;
  using Element = const UrdfElement&;
  using Read = std::function<void(Element)>;
  static constexpr bool required = true;
  static constexpr double infinite = std::numeric_limits<double>::infinity();

  void robot(Element e) {
    std::string version = "1.0";
    e.attributes({{"name", name, &robot_.name, required}, {"version", text, &version}});
    e.children({{"link", any, [&](Element c) { link(c); }},
                {"joint", any, [&](Element c) { joint(c); }},
                {"material", any, [&](Element c) { materials_.push_back(material(c)); }}});
    if (version != "1.0")
      document_.refuse(e.at_value("version"), "URDF version " + shown_quoted(version) + " is not known, only '1.0'");
  }

  void check_count(Element e, std::size_t count, std::size_t most, const char* what) {
    if (count > most) document_.stop(e.at(), "more than " + std::to_string(most) + " " + what);
  }

  static Read leaf(const std::vector<UrdfAttribute>& attributes) {
    return [attributes](Element e) { e.leaf(attributes); };
  }

  // Links

  void link(Element e) {
    UrdfLink& to = robot_.links.emplace_back();
    check_count(e, robot_.links.size(), most_read, "links");
    to.at = e.at(), to.name_at = e.at_value("name");
    e.attributes({{"name", name, &to.name, required}});
    e.children({{"inertial", at_most_one, [&](Element c) { inertial(c, to); }},
                {"visual", any, [&](Element c) { visual(c, to); }},
                {"collision", any, [&](Element c) { collision(c, to); }}});
  }

  void inertial(Element e, UrdfLink& to) {
    Inertia& body = to.inertia.emplace();
    Pose pose;
    e.attributes({});
    e.children({{"origin", at_most_one, origin(pose)},
                {"mass", one, leaf({{"value", positive, &body.mass_kg, required}})},
                {"inertia", one, [&](Element c) { inertia(c, body, to.name); }}});
    body = moved(body, pose);
  }

  void inertia(Element e, Inertia& body, const std::string& link) {
    const bool right = e.leaf({{"ixx", number, &body.xx, required},
                               {"iyy", number, &body.yy, required},
                               {"izz", number, &body.zz, required},
                               {"ixy", number, &body.xy, required},
                               {"ixz", number, &body.xz, required},
                               {"iyz", number, &body.yz, required}});
    const auto defect = right ? inertia_defect(body) : std::nullopt;
    if (defect) document_.refuse(e.at(), "the inertia of link " + shown_quoted(link) + " " + *defect);
  }

  Read origin(Pose& to) {
    return [&to](Element e) {
      Vec3 rpy{};
      e.leaf({{"xyz", vector, to.position_m.data()}, {"rpy", vector, rpy.data()}});
      to.orientation = rotation_of(rpy);
    };
  }

  void visual(Element e, UrdfLink& link) {
    UrdfGeometry& to = link.visuals.emplace_back();
    to.geometry.link = link.name;
    e.attributes({{"name", name, &to.geometry.name}});
    e.children({{"origin", at_most_one, origin(to.geometry.pose)},
                {"geometry", one, [&](Element c) { shape(c, to); }},
                {"material", at_most_one, [&](Element c) { to.material = material(c); }}});
  }

  void collision(Element e, UrdfLink& link) {
    UrdfGeometry& to = link.collisions.emplace_back();
    to.geometry.link = link.name;
    e.attributes({{"name", name, &to.geometry.name}});
    e.children(
        {{"origin", at_most_one, origin(to.geometry.pose)}, {"geometry", one, [&](Element c) { shape(c, to); }}});
  }

  void shape(Element e, UrdfGeometry& to) {
    Box box;
    Sphere sphere;
    Cylinder cylinder;
    Mesh mesh;
    bool taken = false;  // the first counts
    const auto is = [&](auto& read, const std::vector<UrdfAttribute>& attributes) -> Read {
      return [&, attributes](Element c) {
        c.leaf(attributes);
        if (std::exchange(taken, true)) return;
        to.geometry.shape = read;
        to.mesh_at = c.at(), to.file_at = c.at_value("filename");  // of a mesh; of others nobody asks
      };
    };
    e.attributes({});
    const std::size_t there = e.children(
        {{"box", any, is(box, {{"size", positive_vector, box.size_m.data(), required}})},
         {"sphere", any, is(sphere, {{"radius", positive, &sphere.radius_m, required}})},
         {"cylinder", any,
          is(cylinder,
             {{"radius", positive, &cylinder.radius_m, required}, {"length", positive, &cylinder.length_m, required}})},
         {"mesh", any, is(mesh, {{"filename", name, &mesh.file, required}, {"scale", scale, mesh.scale.data()}})}});
    if (there == 0) document_.refuse(e.at(), "<geometry> is empty: <box>, <sphere>, <cylinder> or <mesh> was expected");
  }

  UrdfMaterial material(Element e) {
    UrdfMaterial to{.at = e.at(), .name_at = e.at_value("name")};
    std::array<double, 4> rgba{0, 0, 0, 1};  // of a texture alone
    const auto colored = [&](const std::vector<UrdfAttribute>& attributes) -> Read {
      return [&, attributes](Element c) {
        c.leaf(attributes);
        for (double& part : rgba) part = static_cast<double>(static_cast<float>(part));
        to.color = rgba;
      };
    };
    e.attributes({{"name", name, &to.name, required}});
    e.children({{"color", at_most_one, colored({{"rgba", color, rgba.data(), required}})},
                {"texture", at_most_one, colored({{"filename", name, nullptr, required}})}});
    return to;
  }

  // A name stands for a material of the robot, or of a visual before; who defined it first has defined it.
  void paint() {
    std::map<std::string, std::array<double, 4>> known;
    for (const UrdfMaterial& m : materials_) {
      if (!m.color) document_.refuse(m.at, "material " + shown_quoted(m.name) + " has neither <color> nor <texture>");
      if (!known.emplace(m.name, m.color.value_or(Geometry{}.color)).second)
        document_.refuse(m.name_at, "material " + shown_quoted(m.name) + " is defined twice");
    }
    for (UrdfLink& link : robot_.links) {
      for (UrdfGeometry& visual : link.visuals) {
        const auto& m = visual.material;
        if (!m || m->name.empty()) continue;
        const auto found = m->color ? known.emplace(m->name, *m->color).first : known.find(m->name);
        if (found == known.end()) {
          std::vector<std::string> names;
          names.reserve(known.size());
          for (const auto& entry : known) names.push_back(entry.first);
          document_.refuse(m->name_at,
                           "material " + shown_quoted(m->name) + " is not defined" + did_you_mean(m->name, names));
          continue;
        }
        if (m->color && *m->color != found->second)
          document_.warn(m->at, "material " + shown_quoted(m->name) + " had another color before, which counts");
        visual.geometry.color = found->second;
      }
    }
  }

  // Joints

  void joint(Element e) {
    UrdfJoint& to = robot_.joints.emplace_back();
    check_count(e, robot_.joints.size(), most_read, "joints");
    to.at = e.at(), to.name_at = e.at_value("name");
    std::string type;
    e.attributes({{"name", name, &to.name, required}, {"type", name, &type, required}});
    to.joint.name = to.name;
    to.joint.lower_rad = -infinite, to.joint.upper_rad = to.joint.velocity_max_rad_s = infinite;
    set_type(e, to, type);
    const bool bounded = type == "revolute" || type == "prismatic";
    bool limited = false;
    e.children({{"origin", at_most_one, origin(to.joint.origin)},
                {"parent", one, end(to.parent)},
                {"child", one, end(to.child)},
                {"axis", at_most_one, [&](Element c) { axis(c, to); }},
                {"limit", at_most_one, [&](Element c) { limited = true, limit(c, to, bounded); }},
                {"dynamics", at_most_one, [&](Element c) { dynamics(c, to.joint); }},
                {"mimic", at_most_one, [&](Element c) { mimic(c, to.mimic.emplace()); }},
                {"safety_controller", at_most_one,
                 leaf({{"soft_lower_limit", number},
                       {"soft_upper_limit", number},
                       {"k_position", number},
                       {"k_velocity", number, nullptr, required}})},
                {"calibration", at_most_one,
                 leaf({{"rising", number}, {"falling", number}, {"reference_position", number}})}});
    if (bounded && !limited)
      document_.refuse(to.at, type + " joint " + shown_quoted(to.name) + " has no <limit>" +
                                  (type == "revolute" ? "; without limits it is 'continuous'" : ""));
  }

  void set_type(Element e, UrdfJoint& to, const std::string& type) {
    const std::vector<std::string> known{"revolute", "continuous", "prismatic", "fixed"};
    to.moves = type != "fixed";
    if (to.moves) check_count(e, ++moving_, max_joints, "moving joints");
    if (type == "continuous") to.joint.type = JointType::continuous;
    if (type == "prismatic") to.joint.type = JointType::prismatic;
    if (type.empty() || std::find(known.begin(), known.end(), type) != known.end()) return;
    if (type == "floating" || type == "planar") {
      return document_.refuse(e.at_value("type"), "joint " + shown_quoted(to.name) + " is " + type +
                                                      ", which is not supported: the root link floats by itself; use "
                                                      "revolute, continuous, prismatic or fixed");
    }
    const std::string hint = did_you_mean(type, known);
    document_.refuse(e.at_value("type"),
                     "unknown joint type " + shown_quoted(type) +
                         (hint.empty() ? "; known are: revolute, continuous, prismatic, fixed" : hint));
  }

  static Read end(UrdfEnd& to) {
    return [&to](Element e) {
      to.at = e.at_value("link");
      e.leaf({{"link", name, &to.link, required}});
    };
  }

  void axis(Element e, UrdfJoint& to) {
    constexpr double tolerance = 1e-3;
    Vec3 v{};
    if (!e.leaf({{"xyz", vector, v.data(), required}}) || !to.moves) return;
    const double norm = std::hypot(v[0], v[1], v[2]);
    const std::string what = "the axis of joint " + shown_quoted(to.name);
    if (!(norm > 0)) return document_.refuse(e.at_value("xyz"), what + " is zero: it has no direction");
    if (!(std::abs(norm - 1) <= tolerance)) {
      std::array<char, 160> meant{};
      std::snprintf(meant.data(), meant.size(), " has the length %.6g instead of 1, did you mean '%.6g %.6g %.6g'?",
                    norm, v[0] / norm, v[1] / norm, v[2] / norm);
      document_.refuse(e.at_value("xyz"), what + meant.data());
    }
    const Quat unit = normalized({0, v[0], v[1], v[2]});
    to.joint.axis = {unit[1], unit[2], unit[3]};
  }

  void limit(Element e, UrdfJoint& to, bool bounded) {
    constexpr double unread = std::numeric_limits<double>::quiet_NaN();  // stays where the text is no number
    double lower = e.has("lower") ? unread : 0, upper = e.has("upper") ? unread : 0;
    e.leaf({{"lower", number, &lower},
            {"upper", number, &upper},
            {"effort", not_negative, &to.joint.effort_max_Nm, required},
            {"velocity", not_negative, &to.joint.velocity_max_rad_s, required}});
    const bool given = e.has("lower") || e.has("upper");
    const std::string what = "joint " + shown_quoted(to.name);
    if (to.joint.type == JointType::continuous && given)
      document_.warn(e.at(), what + " is continuous: its 'lower' and 'upper' are not used");
    if (!bounded) return;
    to.joint.lower_rad = lower, to.joint.upper_rad = upper;
    if (!given) document_.refuse(e.at(), what + " has neither 'lower' nor 'upper' in its <limit>");
    if (lower > upper)
      document_.refuse(
          e.at(), what + " has its lower limit " + e.text("lower", "0") + " above its upper " + e.text("upper", "0"));
  }

  void dynamics(Element e, Joint& to) {
    e.leaf({{"damping", not_negative, &to.damping_Nms_per_rad}, {"friction", not_negative, &to.friction_Nm}});
    if (!e.has("damping") && !e.has("friction"))
      document_.refuse(e.at(), "<dynamics> has neither 'damping' nor 'friction'");
  }

  static void mimic(Element e, UrdfMimic& to) {
    to.at = e.at(), to.joint_at = e.at_value("joint");
    e.leaf(
        {{"joint", name, &to.joint, required}, {"multiplier", number, &to.multiplier}, {"offset", number, &to.offset}});
  }

  UrdfDocument& document_;
  UrdfDescription robot_;
  std::vector<UrdfMaterial> materials_;  // of the robot itself
  std::size_t moving_ = 0;               // joints
};

}  // namespace

UrdfDescription read_description(UrdfDocument& document) { return UrdfReader(document).run(); }

}  // namespace kadans
