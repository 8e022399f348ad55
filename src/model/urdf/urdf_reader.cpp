// URDF's elements, one function each: which attributes and children they have, and what these may not be.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <utility>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "kadans/signal/capacity.h"
#include "kadans/signal/nearest_name.h"
#include "signal/number_text.h"
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
  if (is_xacro(element)) document.refuse(e.at(), e.shown_name() + advice, "xacro element");
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string_view name = a->Name(), value = a->Value();
    if (value.find("${") != std::string_view::npos || value.find("$(") != std::string_view::npos)
      document.refuse(e.at_value(name), "'" + shown(value) + "'" + advice, "xacro value");
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
    fix_mimics();
    free_root();
    for (const auto* e = document_.root().FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      find_transmissions(*e);
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
    e.attributes({{"name", text, &robot_.name}, {"version", text, &version}});
    e.children({{"link", any, [&](Element c) { link(c); }},
                {"joint", any, [&](Element c) { joint(c); }},
                {"transmission", any, [](Element) {}},
                {"ros2_control", any, [](Element) {}},
                {"material", any, [&](Element c) { materials_.push_back(material(c)); }}});
    if (read_value(name, robot_.name, nullptr)) {
      robot_.name = std::filesystem::path(document_.file()).stem().string();
      document_.warn(e.at_value("name"), "this <robot> has no name that can be used, and gets its file's");
    }
    if (version != "1.0")
      document_.warn(e.at_value("version"), "URDF version " + shown_quoted(version) + " is read as '1.0'");
  }

  void find_transmissions(const tinyxml2::XMLElement& e) {
    const std::string_view kind = e.Name();
    if (kind == "transmission") return read_transmission(document_, e, robot_);
    if (kind != "ros2_control") return;
    for (const auto* child = e.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
      if (child->Name() == std::string_view("transmission")) read_transmission(document_, *child, robot_);
  }

  void check_count(Element e, std::size_t count, std::size_t most, const char* what) {
    if (count > most)
      document_.stop(e.at(), "more than " + std::to_string(most) + " " + what + ": make 'fixed' what need not move");
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
    Inertia body;
    Pose pose;
    bool tensor = false;
    to.inertia_at = e.at();
    e.attributes({});
    e.children({{"origin", at_most_one, origin(pose)},
                {"mass", at_most_one, leaf({{"value", not_negative, &body.mass_kg, required}})},
                {"inertia", at_most_one, [&](Element c) { tensor = true, inertia(c, body, to); }}});
    const std::string what = "link " + shown_quoted(to.name);
    if (!(body.mass_kg > 0))
      return document_.warn(e.at(), what + " has an <inertial> without mass, and counts as one without it", "mass 0");
    if (!tensor) document_.warn(e.at(), what + " has a mass but no <inertia>: it is a point", "no <inertia>");
    to.inertia = moved(body, pose);
  }

  void inertia(Element e, Inertia& body, UrdfLink& to) {
    to.inertia_at = e.at();
    e.leaf({{"ixx", number, &body.xx, required},
            {"iyy", number, &body.yy, required},
            {"izz", number, &body.zz, required},
            {"ixy", number, &body.xy},
            {"ixz", number, &body.xz},
            {"iyz", number, &body.yz}});
    if (!e.has("ixy") || !e.has("ixz") || !e.has("iyz"))
      document_.warn(e.at(), "<inertia> has not all of ixy, ixz and iyz: what is missing is taken as 0");
  }

  Read origin(Pose& to) {
    return [&to](Element e) {
      Vec3 rpy{};
      e.leaf({{"xyz", vector, to.position_m.data()}, {"rpy", vector, rpy.data()}});
      to.orientation = rotation_of(rpy);
    };
  }

  void visual(Element e, UrdfLink& link) {
    UrdfGeometry to;
    to.geometry.link = link.name;
    const UrdfDocument::Lenient lenient(document_, "this <visual> is left out");
    e.attributes({{"name", text, &to.geometry.name}});
    std::vector<Piece> pieces;
    e.children({{"origin", at_most_one, origin(to.geometry.pose)},
                {"geometry", at_most_one, [&](Element c) { pieces = shape(c, to); }},
                {"material", at_most_one, [&](Element c) { to.material = material(c); }}});
    if (lenient.clean()) add_pieces(e, pieces, to, link.visuals);
  }

  void collision(Element e, UrdfLink& link) {
    UrdfGeometry to;
    to.geometry.link = link.name;
    e.attributes({{"name", text, &to.geometry.name}});
    std::vector<Piece> pieces;
    e.children({{"origin", at_most_one, origin(to.geometry.pose)},
                {"geometry", at_most_one, [&](Element c) { pieces = shape(c, to); }}});
    add_pieces(e, pieces, to, link.collisions);
  }

  struct Piece {  // of a shape; most have one
    Shape shape;
    double along_z_m = 0;
  };

  void add_pieces(Element e, const std::vector<Piece>& pieces, const UrdfGeometry& of, std::vector<UrdfGeometry>& to) {
    if (pieces.empty()) document_.warn(e.at(), e.shown_name() + " has no shape that could be used, and is left out");
    for (const Piece& piece : pieces) {
      UrdfGeometry& added = to.emplace_back(of);
      added.geometry.shape = piece.shape;
      if (piece.along_z_m != 0)
        added.geometry.pose = compose(of.geometry.pose, {{0, 0, piece.along_z_m}, {1, 0, 0, 0}});
    }
  }

  // The first shape counts. One without extent is none.
  std::vector<Piece> shape(Element e, UrdfGeometry& to) {
    Box box;
    Sphere sphere;
    Cylinder cylinder, capsule;
    Mesh mesh;
    std::vector<Piece> pieces;
    bool taken = false;
    const auto is = [&](const std::vector<UrdfAttribute>& attributes, const std::function<void()>& take) -> Read {
      return [&, attributes, take](Element c) {
        const bool right = c.leaf(attributes);
        if (std::exchange(taken, true))
          document_.warn(c.at(), "a second shape in one <geometry>: the first counts");
        else if (right)
          take();
        to.mesh_at = c.at(), to.file_at = c.at_value("filename");  // of a mesh; of others nobody asks
      };
    };
    const auto add = [&](const Shape& made, bool extended, double along_z_m = 0) {
      if (extended) pieces.push_back({made, along_z_m});
    };
    e.attributes({});
    e.children(
        {{"box", any,
          is({{"size", not_negative_vector, box.size_m.data(), required}},
             [&] { add(box, box.size_m[0] > 0 && box.size_m[1] > 0 && box.size_m[2] > 0); })},
         {"sphere", any,
          is({{"radius", not_negative, &sphere.radius_m, required}}, [&] { add(sphere, sphere.radius_m > 0); })},
         {"cylinder", any, is(round(cylinder), [&] { add(cylinder, cylinder.radius_m > 0 && cylinder.length_m > 0); })},
         {"capsule", any,
          is(round(capsule),
             [&] {  // exactly: a cylinder with a ball at each end
               add(capsule, capsule.radius_m > 0 && capsule.length_m > 0);
               for (const double side : {-0.5, 0.5})
                 add(Sphere{capsule.radius_m}, capsule.radius_m > 0, side * capsule.length_m);
             })},
         {"mesh", any, is({{"filename", text, &mesh.file, required}, {"scale", vector, mesh.scale.data()}}, [&] {
            add(mesh, !mesh.file.empty() && mesh.scale[0] * mesh.scale[1] * mesh.scale[2] != 0);
          })}});
    return pieces;
  }

  static std::vector<UrdfAttribute> round(Cylinder& to) {
    return {{"radius", not_negative, &to.radius_m, required}, {"length", not_negative, &to.length_m, required}};
  }

  UrdfMaterial material(Element e) {
    UrdfMaterial to{.at = e.at(), .name_at = e.at_value("name")};
    const UrdfDocument::Lenient lenient(document_, "this colour is not used");
    std::array<double, 4> rgba{0, 0, 0, 1};  // of a texture alone
    const auto colored = [&](const std::vector<UrdfAttribute>& attributes) -> Read {
      return [&, attributes](Element c) {
        if (!c.leaf(attributes)) return;
        for (double& part : rgba) part = static_cast<double>(static_cast<float>(part));
        to.color = rgba;
      };
    };
    e.attributes({{"name", text, &to.name}});
    e.children({{"color", at_most_one, colored({{"rgba", color, rgba.data(), required}})},
                {"texture", at_most_one, colored({{"filename", text, nullptr}})}});
    if (to.name.empty()) document_.warn(e.at(), "<material> has no name: it colours this one shape");
    return to;
  }

  // A name stands for a material of the robot, or of a visual before; who defined it first has defined it.
  void paint() {
    std::map<std::string, std::array<double, 4>> known;
    for (const UrdfMaterial& m : materials_) {
      const std::string what = "material " + shown_quoted(m.name);
      if (!m.color) document_.warn(m.at, what + " has neither <color> nor <texture>, and is grey", "material grey");
      if (!known.emplace(m.name, m.color.value_or(Geometry{}.color)).second)
        document_.warn(m.name_at, what + " is defined twice: the first counts", "material twice");
    }
    for (UrdfLink& link : robot_.links) {
      for (UrdfGeometry& visual : link.visuals) {
        if (visual.material) visual.geometry.color = color_of(*visual.material, known);
      }
    }
  }

  std::array<double, 4> color_of(const UrdfMaterial& m, std::map<std::string, std::array<double, 4>>& known) {
    if (m.name.empty()) return m.color.value_or(Geometry{}.color);
    const auto found = m.color ? known.emplace(m.name, *m.color).first : known.find(m.name);
    const std::string what = "material " + shown_quoted(m.name);
    if (found == known.end()) {
      std::vector<std::string> names;
      names.reserve(known.size());
      for (const auto& entry : known) names.push_back(entry.first);
      document_.warn(m.name_at, what + " is not defined, and is grey" + did_you_mean(m.name, names),
                     "material missing");
      return Geometry{}.color;
    }
    if (m.color && *m.color != found->second)
      document_.warn(m.at, what + " had another color before, which counts", "material color");
    return found->second;
  }

  // Joints

  void joint(Element e) {
    UrdfJoint& to = robot_.joints.emplace_back();
    check_count(e, robot_.joints.size(), most_read, "joints");
    to.at = e.at(), to.name_at = e.at_value("name");
    std::string type;
    e.attributes({{"name", name, &to.name, required}, {"type", name, &type, required}});
    to.joint.name = to.name;
    to.joint.lower_rad = -infinite, to.joint.upper_rad = infinite, to.joint.velocity_max_rad_s = no_limit;
    set_type(e, to, type);
    const bool bounded = type == "revolute" || type == "prismatic";
    bool limited = false;
    const auto of_moving = [&](const Read& read) -> Read {  // of a fixed joint nothing else counts
      return [&to, read](Element c) {
        if (to.moves) read(c);
      };
    };
    e.children({{"origin", at_most_one, origin(to.joint.origin)},
                {"parent", one, end(to.parent)},
                {"child", one, end(to.child)},
                {"axis", at_most_one, of_moving([&](Element c) { axis(c, to); })},
                {"limit", at_most_one, of_moving([&](Element c) { limited = true, limit(c, to, bounded); })},
                {"dynamics", at_most_one, of_moving([&](Element c) { dynamics(c, to.joint); })},
                {"mimic", at_most_one, [&](Element c) { mimic(c, to); }},
                {"safety_controller", at_most_one, of_moving([&](Element c) { soft_limits(c, to); })},
                {"calibration", at_most_one, [&](Element c) { unused(c); }}});
    if (bounded && !limited)
      document_.warn(to.at,
                     type + " joint " + shown_quoted(to.name) + " has no <limit>: it has no end stops and no motor",
                     "no <limit>");
    if (to.joint.soft_lower_rad > to.joint.soft_upper_rad || to.joint.soft_lower_rad > to.joint.upper_rad ||
        to.joint.soft_upper_rad < to.joint.lower_rad)
      document_.refuse(to.at, "joint " + shown_quoted(to.name) + " has soft limits that leave it no room");
  }

  void unused(Element e) { document_.warn(e.at(), e.shown_name() + " is not used"); }

  void set_type(Element e, UrdfJoint& to, const std::string& type) {
    const std::vector<std::string> known{"revolute", "continuous", "prismatic", "fixed"};
    to.moves = type != "fixed";
    if (to.moves && type != "floating") check_count(e, ++moving_, max_joints, "moving joints");
    if (type == "continuous") to.joint.type = JointType::continuous;
    if (type == "prismatic") to.joint.type = JointType::prismatic;
    to.floats = type == "floating";
    if (type.empty() || to.floats || std::find(known.begin(), known.end(), type) != known.end()) return;
    const auto several = [&](const std::string& instead) {
      document_.refuse(e.at_value("type"), "joint " + shown_quoted(to.name) + " is " + type +
                                               ", a joint of several axes: write it as " + instead +
                                               ", with a link of a small mass between two");
    };
    if (type == "planar") return several("two prismatic joints and a continuous one");
    if (type == "ball" || type == "spherical") return several("three revolute joints");
    const std::string hint = did_you_mean(type, known);
    document_.refuse(e.at_value("type"),
                     "unknown joint type " + shown_quoted(type) +
                         (hint.empty() ? "; known are: revolute, continuous, prismatic, fixed" : hint));
  }

  // The root link floats by itself. A root that is there only to carry a floating joint says the same, and goes.
  void free_root() {
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) {
      const UrdfJoint joint = robot_.joints[i];
      if (!joint.floats) continue;
      const auto is_parent = [&](const UrdfJoint& other) { return other.parent.link == joint.parent.link; };
      const auto hangs = [&](const UrdfJoint& other) { return other.child.link == joint.parent.link; };
      const auto parent = std::ranges::find(robot_.links, joint.parent.link, &UrdfLink::name);
      if (parent != robot_.links.end() && !parent->inertia && parent->collisions.empty() &&
          std::ranges::count_if(robot_.joints, is_parent) == 1 && std::ranges::none_of(robot_.joints, hangs)) {
        document_.warn(joint.at, "joint " + shown_quoted(joint.name) +
                                     " is floating, as every robot is here: it and link " + shown_quoted(parent->name) +
                                     " are left out");
        robot_.links.erase(parent);
        robot_.joints.erase(robot_.joints.begin() + static_cast<std::ptrdiff_t>(i--));
      } else {
        document_.refuse(joint.at,
                         "joint " + shown_quoted(joint.name) +
                             " is floating; only a joint below a root without mass, shape and other joints may "
                             "be: write it as three prismatic and three revolute joints, with a link of a "
                             "small mass between two");
      }
    }
  }

  // Who mimics a fixed joint does not move either.
  void fix_mimics() {
    for (bool again = true; std::exchange(again, false);) {
      for (UrdfJoint& joint : robot_.joints) {
        if (!joint.moves || !joint.mimic) continue;
        const auto leader = std::ranges::find(robot_.joints, joint.mimic->joint, &UrdfJoint::name);
        if (leader == robot_.joints.end() || leader->moves) continue;
        document_.warn(joint.mimic->at,
                       "joint " + shown_quoted(joint.name) + " mimics the fixed joint " + shown_quoted(leader->name) +
                           ", and is fixed",
                       "mimic of a fixed joint");
        joint.joint.origin = compose(joint.joint.origin, motion_of(joint.joint, joint.mimic->offset));
        joint.moves = false, joint.mimic.reset(), again = true;
      }
    }
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
    if (!e.leaf({{"xyz", vector, v.data(), required}})) return;
    const double norm = length(v);
    const std::string what = "the axis of joint " + shown_quoted(to.name);
    if (!(norm > 0)) return document_.refuse(e.at_value("xyz"), what + " is zero: it has no direction");
    if (!(std::abs(norm - 1) <= tolerance)) {
      const std::string meant = printed(" has the length %.6g instead of 1: '%.6g %.6g %.6g' is used", norm,
                                        v[0] / norm, v[1] / norm, v[2] / norm);
      document_.warn(e.at_value("xyz"), what + meant, "axis length");
    }
    const Quat unit = normalized({0, v[0], v[1], v[2]});
    to.joint.axis = {unit[1], unit[2], unit[3]};
  }

  void limit(Element e, UrdfJoint& to, bool bounded) {
    constexpr double unread = std::numeric_limits<double>::quiet_NaN();  // stays where the text is no number
    double lower = e.has("lower") ? unread : 0, upper = e.has("upper") ? unread : 0, effort = 0, velocity = no_limit;
    e.leaf({{"lower", UrdfValue::unbounded, &lower},
            {"upper", UrdfValue::unbounded, &upper},
            {"effort", UrdfValue::unbounded, &effort},
            {"velocity", UrdfValue::unbounded, &velocity}});
    set_effort(e, to, effort);
    set_velocity(e, to, velocity);
    const bool given = e.has("lower") || e.has("upper");
    const std::string what = "joint " + shown_quoted(to.name);
    if (to.joint.type == JointType::continuous && given)
      document_.warn(e.at(), what + " is continuous: its 'lower' and 'upper' are not used", "limits of continuous");
    if (!bounded) return;
    if (lower > upper)
      document_.refuse(
          e.at(), what + " has its lower limit " + e.text("lower", "0") + " above its upper " + e.text("upper", "0"));
    if (!given && to.joint.type == JointType::revolute) {  // URDF has 0 there; nobody means a motor that cannot move
      document_.warn(e.at(), what + " has a <limit> without 'lower' and 'upper': it turns without end stops",
                     "no lower, no upper");
      to.joint.type = JointType::continuous;
      to.joint.lower_rad = -infinite, to.joint.upper_rad = infinite;
      return;
    }
    if (lower == upper)
      document_.warn(e.at(), what + " cannot move: its lower and its upper limit are " + e.text("lower", "0"),
                     "cannot move");
    if (std::abs(lower) >= no_limit || std::abs(upper) >= no_limit)
      document_.warn(e.at(), what + " has a limit of 1e6 or more: it is taken as no end stop", "no end stop");
    to.joint.lower_rad = lower <= -no_limit ? -infinite : lower;
    to.joint.upper_rad = upper >= no_limit ? infinite : upper;
    if (to.joint.type == JointType::revolute && std::isinf(to.joint.lower_rad) && std::isinf(to.joint.upper_rad))
      to.joint.type = JointType::continuous;
  }

  void set_effort(Element e, UrdfJoint& to, double effort) {
    const std::string what = "joint " + shown_quoted(to.name);
    if (!e.has("effort"))
      document_.warn(e.at(), what + " has a <limit> without 'effort': it has no motor", "no effort");
    if (effort < 0)
      document_.warn(e.at_value("effort"), what + " has a negative 'effort': it has no motor", "negative effort");
    if (effort >= no_limit)
      document_.warn(e.at_value("effort"),
                     what +
                         " has an 'effort' of 1e6 or more, which no motor has: torque_max_Nm in the robot's "
                         "plant.drives gives the true one",
                     "large effort");
    to.joint.effort_max_Nm = std::clamp(effort, 0.0, 1e9);
  }

  void set_velocity(Element e, UrdfJoint& to, double velocity) {
    const std::string what = "joint " + shown_quoted(to.name);
    if (!e.has("velocity"))
      document_.warn(e.at(), what + " has a <limit> without 'velocity': its speed has no limit", "no velocity");
    if (e.has("velocity") && (velocity <= 0 || velocity >= no_limit))
      document_.warn(e.at_value("velocity"),
                     what + " has a 'velocity' " + (velocity <= 0 ? "that is not above 0" : "of 1e6 or more") +
                         ": its speed has no limit",
                     velocity <= 0 ? "zero velocity" : "large velocity");
    to.joint.velocity_max_rad_s = velocity <= 0 ? no_limit : std::min(velocity, no_limit);
  }

  void soft_limits(Element e, UrdfJoint& to) {
    double lower = 0, upper = 0;
    e.leaf({{"soft_lower_limit", UrdfValue::unbounded, &lower},
            {"soft_upper_limit", UrdfValue::unbounded, &upper},
            {"k_position", UrdfValue::unbounded},
            {"k_velocity", UrdfValue::unbounded}});
    if (e.has("k_position") || e.has("k_velocity"))
      document_.warn(
          e.at(),
          "'k_position' and 'k_velocity' of <safety_controller> are not used: the safety layer slows a joint "
          "down before its limit");
    if (to.joint.type == JointType::continuous || lower == upper) return;  // by URDF's rules: none
    if (e.has("soft_lower_limit")) to.joint.soft_lower_rad = lower;
    if (e.has("soft_upper_limit")) to.joint.soft_upper_rad = upper;
  }

  void dynamics(Element e, Joint& to) {
    e.leaf({{"damping", not_negative, &to.damping_Nms_per_rad},
            {"friction", not_negative, &to.friction_Nm},
            {"armature", not_negative, &to.rotor_inertia_kg_m2}});  // MuJoCo's word
  }

  void mimic(Element e, UrdfJoint& joint) {
    if (!joint.moves)
      return document_.warn(e.at(), "joint " + shown_quoted(joint.name) + " is fixed: its <mimic> is not used",
                            "mimic of fixed");
    UrdfMimic& to = joint.mimic.emplace();
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
