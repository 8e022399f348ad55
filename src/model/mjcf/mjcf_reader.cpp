// From the bodies, joints, geoms and actuators of an MJCF to the links and joints of a description.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "kadans/model/inertia.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/mjcf.h"
#include "kadans/signal/capacity.h"
#include "mjcf_source.h"
#include "mjcf_values.h"
#include "model/urdf/urdf_description.h"
#include "signal/input_file.h"
#include "signal/nearest_name.h"
#include "signal/number_text.h"
#include "urdf_text.h"

namespace kadans {
namespace {

using Xml = tinyxml2::XMLElement;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double assumed_force = 100;   // N or Nm, of an actuator that says none
constexpr double density_kg_m3 = 1000;  // MuJoCo's default
constexpr std::size_t most_bodies = 1000;

Inertia tensor(double mass_kg, const Vec3& moments) {
  Inertia body;
  body.mass_kg = mass_kg, body.xx = moments[0], body.yy = moments[1], body.zz = moments[2];
  return body;
}

class MjcfReader {
 public:
  MjcfReader(UrdfDocument& document, std::vector<MjcfPose>& poses)
      : document_(document), defaults_(document), poses_(poses) {}

  UrdfDescription run() {
    const Xml& root = document_.root();
    if (std::string_view(root.Name()) != "mujoco")
      document_.stop(at(root), "the first element is <" + shown(root.Name()) + ">, an MJCF's is <mujoco>");
    each(root, "compiler", [&](const Xml& e) { compiler(e); });
    each(root, "default", [&](const Xml& e) { defaults_.read(e); });
    each(root, "asset", [&](const Xml& e) { assets(e); });
    document_.throw_if_refused();
    name_robot(root);
    world(root);
    if (robot_.links.empty()) document_.stop(at(root), "this MJCF has no body with a joint, so it has no robot");
    each(root, "tendon", [&](const Xml& e) { tendons(e); });
    each(root, "equality", [&](const Xml& e) { equalities(e); });
    each(root, "actuator", [&](const Xml& e) { actuators(e); });
    bound_efforts();
    each(root, "keyframe", [&](const Xml& e) { keyframes(e); });
    tell_unused(root);
    return std::move(robot_);
  }

 private:
  struct Frame {           // of what a body holds
    std::size_t link = 0;  // of the description
    Pose in_link;          // of the body's frame
    std::string of_class;
  };
  struct Material {
    std::array<double, 4> rgba{0.7, 0.7, 0.7, 1};
  };
  struct Asset {
    std::string file;
    Vec3 scale{1, 1, 1};
  };
  struct Address {  // in qpos
    std::string joint;
    std::size_t at = 0;
    double reference = 0;
  };

  static std::size_t at(const Xml& e) { return UrdfDocument::tag(e).at; }

  template <typename Read>
  static void each(const Xml& parent, const char* name, const Read& read) {
    for (const Xml* e = parent.FirstChildElement(name); e != nullptr; e = e->NextSiblingElement(name)) read(*e);
  }

  MjcfElement element(const Xml& e, const std::string& of_class = {}) { return {document_, defaults_, e, of_class}; }

  // The file as a whole

  void compiler(const Xml& xml) {
    const MjcfElement e = element(xml);
    const std::string angle = e.text("angle", angles_.degrees ? "degree" : "radian");
    if (angle != "degree" && angle != "radian")
      document_.refuse(e.at(), "'angle' is '" + shown(angle) + "', and may be degree or radian");
    angles_.degrees = angle == "degree";
    angles_.sequence = e.text("eulerseq", angles_.sequence);
    if (angles_.sequence.size() != 3 || angles_.sequence.find_first_not_of("xyzXYZ") != std::string::npos) {
      document_.refuse(e.at(), "'eulerseq' is '" + shown(angles_.sequence) + "', and may be three of xyzXYZ");
      angles_.sequence = "xyz";
    }
    meshes_ = e.text("meshdir", e.text("assetdir", meshes_));
    limits_by_range_ = e.flag("autolimits", limits_by_range_).value_or(true);
    if (e.has("inertiafromgeom")) from_geoms_ = e.flag("inertiafromgeom");
    strip_ = e.flag("strippath", strip_).value_or(false);
    if (e.text("coordinate", "local") != "local")
      document_.refuse(
          e.at(),
          "global coordinates are no longer MuJoCo's: save the model once by MuJoCo 2, which writes local ones");
    if (e.number("settotalmass", -1) > 0)
      document_.refuse(e.at(), "'settotalmass' scales masses that stand in the file: write the scaled ones");
  }

  void name_robot(const Xml& root) {
    const char* const name = root.Attribute("model");
    robot_.name = name == nullptr || read_value(UrdfValue::name, name, nullptr)
                      ? std::filesystem::path(document_.file()).stem().string()
                      : name;
  }

  void assets(const Xml& all) {
    each(all, "mesh", [&](const Xml& xml) {
      const MjcfElement e = element(xml);
      std::filesystem::path file = e.text("file");
      if (strip_) file = file.filename();
      const std::string name = e.text("name", file.stem().string());
      if (file.empty())
        document_.warn(e.at(), "mesh " + shown_quoted(name) + " is given by its vertices, and is left out",
                       "mesh of vertices");
      if (e.has("refpos") || e.has("refquat"))
        document_.warn(e.at(), "'refpos' and 'refquat' of mesh " + shown_quoted(name) + " are not used", "refpos");
      meshes_by_name_[name] = {file.empty() ? "" : (std::filesystem::path(meshes_) / file).string(),
                               vec3(e.numbers("scale", 3, 3, {1, 1, 1}))};
    });
    each(all, "material", [&](const Xml& xml) {
      const MjcfElement e = element(xml);
      const std::vector<double> rgba = e.numbers("rgba", 4, 4, {0.7, 0.7, 0.7, 1});
      std::copy(rgba.begin(), rgba.end(), materials_[e.text("name")].rgba.begin());
    });
  }

  void tell_unused(const Xml& root) {
    const std::set<std::string_view> silent{"compiler", "option",   "size",     "visual",    "statistic",
                                            "default",  "custom",   "asset",    "worldbody", "tendon",
                                            "equality", "actuator", "keyframe", "sensor",    "include"};
    for (const Xml* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (!silent.contains(e->Name())) document_.warn(at(*e), "<" + shown(e->Name()) + "> is not used");
    }
  }

  // Bodies

  // Whether a body of this tree moves on a joint of its own, other than a free one.
  static bool is_moved(const Xml& body) {
    for (const Xml* e = body.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      const char* const type = e->Attribute("type");
      if (name == "joint" && (type == nullptr || type != std::string_view("free"))) return true;
      if ((name == "body" || name == "frame") && is_moved(*e)) return true;
    }
    return false;
  }

  // Bodies of the world without joints of their own are scenery. One body that is free, or that stands fast, is the
  // robot; several that stand fast are one, bolted to the world.
  void world(const Xml& root) {
    std::vector<std::pair<const Xml*, Pose>> bodies;
    std::string of_class;
    each(root, "worldbody", [&](const Xml& e) {
      collect(e, {}, bodies);
      if (const char* const c = e.Attribute("childclass")) of_class = c;
    });
    std::vector<std::pair<const Xml*, Pose>> moved;
    std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(moved),
                 [](const auto& body) { return is_moved(*body.first); });
    const auto is_free = [&](const auto& body) { return free_joint(*body.first) != nullptr; };
    const std::size_t free = static_cast<std::size_t>(std::ranges::count_if(moved, is_free));
    if (free > 1 || (free == 1 && moved.size() > 1))
      document_.stop(at(*moved[1].first), "several robots stand in this MJCF: give each a file of its own");
    // MuJoCo numbers the positions of all joints, those of scenery too.
    const bool own_root = free == 0 && !moved.empty();  // what is bolted down hangs on a link of this name
    if (own_root) {
      robot_.links.push_back({.name = "world"});
      link_names_.insert("world");
    }
    for (const auto& [body, pose] : bodies) {
      if (!is_moved(*body)) {
        skip_positions(*body);
        if (free_joint(*body) != nullptr)
          document_.warn(at(*body),
                         "body " + shown_quoted(name_of(*body)) +
                             " is no part of the robot: it is left out; objects are a scenario's (world)",
                         "object");
        continue;
      }
      this->body(*body, own_root ? std::optional<Frame>(Frame{0, pose, of_class}) : std::nullopt, of_class);
    }
  }

  void collect(const Xml& parent, const Pose& pose, std::vector<std::pair<const Xml*, Pose>>& bodies) {
    for (const Xml* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "body") bodies.emplace_back(e, pose);
      if (name == "frame") collect(*e, compose(pose, element(*e).pose(angles_)), bodies);
      refuse_macro(*e);
    }
  }

  void refuse_macro(const Xml& e) {
    const std::string_view name = e.Name();
    if (name == "replicate" || name == "attach" || name == "composite" || name == "flexcomp")
      document_.refuse(at(e), "<" + shown(name) +
                                  "> makes bodies that are not written down: let MuJoCo compile and save the model "
                                  "(mj_saveLastXML), which writes them");
  }

  static const Xml* free_joint(const Xml& body) {
    for (const Xml* e = body.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const char* const type = e->Attribute("type");
      if (std::string_view(e->Name()) == "freejoint") return e;
      if (std::string_view(e->Name()) == "joint" && type != nullptr && type == std::string_view("free")) return e;
    }
    return nullptr;
  }

  static std::vector<const Xml*> joints_of(const Xml& body) {
    std::vector<const Xml*> all;
    const Xml* const free = free_joint(body);
    each(body, "joint", [&](const Xml& e) {
      if (&e != free) all.push_back(&e);
    });
    return all;
  }

  void skip_positions(const Xml& body) {
    if (free_joint(body) != nullptr) positions_ += 7;
    each(body, "body", [&](const Xml& e) { skip_positions(e); });
  }

  std::string name_of(const Xml& body) const {
    const char* const name = body.Attribute("name");
    return name == nullptr || *name == '\0' ? "body_" + std::to_string(robot_.links.size()) : name;
  }

  void body(const Xml& xml, const std::optional<Frame>& parent, const std::string& of_class) {
    if (robot_.links.size() >= most_bodies) document_.stop(at(xml), "more than 1000 bodies");
    const MjcfElement e = element(xml, of_class);
    UrdfLink link{.name = name_of(xml),
                  .at = e.at(),
                  .name_at = UrdfElement(document_, xml).at_value("name"),
                  .inertia_at = e.at()};
    for (const std::string taken = link.name; !link_names_.insert(link.name).second;)
      link.name = taken + "_" + std::to_string(link_names_.size());
    const std::size_t number = robot_.links.size();
    const std::vector<const Xml*> joints = joints_of(xml);
    const Xml* const free = free_joint(xml);
    if (free != nullptr) {
      positions_ += 7;
      if (parent)
        document_.refuse(at(*free),
                         "body " + shown_quoted(link.name) + " is free inside of another body: a robot is one tree");
    }
    if (joints.size() > 1)
      document_.refuse(at(*joints[1]),
                       "body " + shown_quoted(link.name) + " moves on " + std::to_string(joints.size()) +
                           " joints of its own: write a body of a small mass and inertia for each of them but the "
                           "last, one inside of the other",
                       "several joints");
    for (std::size_t i = 1; i < joints.size(); ++i) {
      if (const char* const name = joints[i]->Attribute("name"); name != nullptr) refused_joints_.insert(name);
    }
    Frame own{number, {}, e.class_name()};
    if (!joints.empty()) {
      const Vec3 anchor = vec3(element(*joints[0], own.of_class).numbers("pos", 3, 3, {0, 0, 0}));
      own.in_link.position_m = {-anchor[0], -anchor[1], -anchor[2]};
    }
    robot_.links.push_back(std::move(link));
    if (parent) hang(e, *parent, own, joints);
    contents(xml, own);
  }

  // The joint between a body and the one around it; without <joint> it stands fast.
  void hang(const MjcfElement& body, const Frame& parent, const Frame& own, const std::vector<const Xml*>& joints) {
    UrdfJoint joint;
    const Pose anchor{{-own.in_link.position_m[0], -own.in_link.position_m[1], -own.in_link.position_m[2]},
                      {1, 0, 0, 0}};
    joint.joint.origin = compose(compose(parent.in_link, body.pose(angles_)), anchor);
    joint.parent = {robot_.links[parent.link].name, body.at()};
    joint.child = {robot_.links[own.link].name, body.at()};
    joint.at = joint.name_at = body.at();
    joint.name = joint.child.link + "_fixed";
    joint.moves = !joints.empty();
    if (joint.moves) move(element(*joints[0], own.of_class), joint);
    while (!joint_names_.insert(joint.name).second) joint.name += "_" + std::to_string(joint_names_.size());
    joint.joint.name = joint.name;
    robot_.joints.push_back(std::move(joint));
  }

  void move(const MjcfElement& e, UrdfJoint& to) {
    const std::string type = e.text("type", "hinge");
    to.at = to.name_at = e.at();
    to.name = e.text("name", to.child.link + "_joint");
    const std::string what = "joint " + shown_quoted(to.name);
    if (type == "ball")
      document_.refuse(
          e.at(),
          what +
              " is a ball, a joint of several axes: write it as three hinges, with a body of a small mass between two");
    else if (type != "hinge" && type != "slide")
      document_.refuse(e.at(), what + " has the unknown type " + shown_quoted(type) +
                                   did_you_mean(type, std::vector<std::string>{"hinge", "slide", "ball", "free"}));
    if (++moving_ > max_joints)
      document_.stop(e.at(), "more than " + std::to_string(max_joints) +
                                 " moving joints: leave out the <joint> of what need not move");
    Joint& joint = to.joint;
    joint.type = type == "slide" ? JointType::prismatic : JointType::revolute;
    const double angle = angles_.degrees && type == "hinge" ? std::numbers::pi / 180 : 1;
    const Vec3 axis = vec3(e.numbers("axis", 3, 3, {0, 0, 1}));
    if (!(length(axis) > 0)) document_.refuse(e.at(), "the axis of " + what + " is zero: it has no direction");
    joint.axis = unit(axis);
    const double reference = e.number("ref", 0) * angle;
    joint.lower_rad = -infinite, joint.upper_rad = infinite, joint.velocity_max_rad_s = no_limit;
    const std::vector<double> range = e.numbers("range", 2, 2, {0, 0});
    if (e.flag("limited").value_or(limits_by_range_ && e.has("range"))) {
      joint.lower_rad = range[0] * angle - reference, joint.upper_rad = range[1] * angle - reference;
      if (range[0] > range[1])
        document_.refuse(e.at(), what + " has its lower limit " + number_text(range[0]) + " above its upper " +
                                     number_text(range[1]));
    } else if (joint.type == JointType::revolute) {
      joint.type = JointType::continuous;
    }
    joint.damping_Nms_per_rad = std::max(0.0, e.numbers("damping", 1, 3, {0})[0]);
    joint.friction_Nm = std::max(0.0, e.number("frictionloss", 0));
    joint.rotor_inertia_kg_m2 = std::max(0.0, e.number("armature", 0));
    if (e.numbers("stiffness", 1, 3, {0})[0] != 0)
      document_.warn(e.at(),
                     what + " has a spring, which is left out: plant.drives says it as parallel_spring_Nm_per_rad",
                     "spring");
    document_.warn(e.at(), what + " has no limit of speed: an MJCF cannot say it, plant.drives can", "no velocity");
    addresses_.push_back({to.name, positions_++, reference});
    if (const auto most = e.numbers("actuatorfrcrange", 2, 2, {0, 0}); most[1] > most[0])
      joint_most_[to.name] = std::max(-most[0], most[1]);
  }

  void contents(const Xml& xml, const Frame& own) {
    const Xml* const inertial = xml.FirstChildElement("inertial");
    if (inertial != nullptr && !from_geoms_.value_or(false)) read_inertial(element(*inertial), own);
    const bool weigh = inertial == nullptr ? from_geoms_.value_or(true) : from_geoms_.value_or(false);
    inside(xml, own, weigh);
  }

  void inside(const Xml& xml, const Frame& own, bool weigh) {
    for (const Xml* e = xml.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view name = e->Name();
      if (name == "geom") geom(element(*e, own.of_class), own, weigh);
      if (name == "body") body(*e, own, own.of_class);
      if (name == "frame") {
        const MjcfElement frame = element(*e, own.of_class);
        inside(*e, {own.link, compose(own.in_link, frame.pose(angles_)), frame.class_name()}, weigh);
      }
      refuse_macro(*e);
    }
  }

  void weld(std::size_t link, const Inertia& body) {
    std::optional<Inertia>& all = robot_.links[link].inertia;
    all = all ? combined(*all, body) : body;
  }

  void read_inertial(const MjcfElement& e, const Frame& own) {
    Inertia body = tensor(e.number("mass", 0), vec3(e.numbers("diaginertia", 3, 3, {0, 0, 0})));
    if (e.has("fullinertia")) {
      const auto m = e.numbers("fullinertia", 6, 6, {0, 0, 0, 0, 0, 0});
      body.xx = m[0], body.yy = m[1], body.zz = m[2], body.xy = m[3], body.xz = m[4], body.yz = m[5];
    }
    robot_.links[own.link].inertia_at = e.at();
    if (body.mass_kg < 0) document_.refuse(e.at(), "a mass is negative");
    if (body.mass_kg > 0) weld(own.link, moved(body, compose(own.in_link, e.pose(angles_))));
  }

  // Geoms

  void geom(const MjcfElement& e, const Frame& own, bool weigh) {
    const std::string mesh = e.text("mesh");
    const std::string type = e.text("type", mesh.empty() ? "sphere" : "mesh");
    Pose pose = e.pose(angles_);
    std::vector<double> size = e.numbers("size", 1, 3, {});
    if (size.empty() && e.has("size")) return;  // it has been refused
    size.resize(3);
    if (e.has("fromto")) {
      const auto ends = e.numbers("fromto", 6, 6, {0, 0, 0, 0, 0, 1});
      const Vec3 way{ends[3] - ends[0], ends[4] - ends[1], ends[5] - ends[2]};
      pose = {{(ends[0] + ends[3]) / 2, (ends[1] + ends[4]) / 2, (ends[2] + ends[5]) / 2}, z_to(way)};
      // Boxes and ellipsoids have a third size, round ones a second, and it is half of the way.
      if (type == "box" || type == "ellipsoid")
        size[1] = size[0], size[2] = length(way) / 2;
      else
        size[1] = length(way) / 2;
    }
    const Pose in_link = compose(own.in_link, pose);
    std::vector<std::pair<Shape, double>> pieces;  // a shape, and how far along z it is
    double volume_m3 = 0;
    Vec3 moments{};  // of a mass of 1
    const double a = size[0], b = size[1], c = size[2];
    if (type == "sphere") {
      pieces = {{Sphere{a}, 0}};
      volume_m3 = 4.0 / 3 * std::numbers::pi * a * a * a;
      moments = {0.4 * a * a, 0.4 * a * a, 0.4 * a * a};
    } else if (type == "box") {
      pieces = {{Box{{2 * a, 2 * b, 2 * c}}, 0}};
      volume_m3 = 8 * a * b * c;
      moments = {(b * b + c * c) / 3, (a * a + c * c) / 3, (a * a + b * b) / 3};
    } else if (type == "cylinder") {
      pieces = {{Cylinder{a, 2 * b}, 0}};
      volume_m3 = std::numbers::pi * a * a * 2 * b;
      moments = {a * a / 4 + b * b / 3, a * a / 4 + b * b / 3, a * a / 2};
    } else if (type == "capsule") {
      pieces = {{Cylinder{a, 2 * b}, 0}, {Sphere{a}, b}, {Sphere{a}, -b}};
      const double tube = std::numbers::pi * a * a * 2 * b, ball = 4.0 / 3 * std::numbers::pi * a * a * a;
      volume_m3 = tube + ball;
      const double t = tube / volume_m3, s = ball / volume_m3;  // two half balls, each 3/8 a beyond its end of the tube
      const double across = t * (a * a / 4 + b * b / 3) + s * (0.4 * a * a + b * b + 0.75 * a * b);
      moments = {across, across, t * a * a / 2 + s * 0.4 * a * a};
    } else if (type == "ellipsoid") {
      document_.warn(e.at(), "an ellipsoid collides and is drawn as a box", "ellipsoid");
      pieces = {{Box{{2 * a, 2 * b, 2 * c}}, 0}};
      volume_m3 = 4.0 / 3 * std::numbers::pi * a * b * c;
      moments = {(b * b + c * c) / 5, (a * a + c * c) / 5, (a * a + b * b) / 5};
    } else if (type == "mesh") {
      const auto found = meshes_by_name_.find(mesh);
      if (found == meshes_by_name_.end()) {
        std::vector<std::string> names;
        for (const auto& [name, asset] : meshes_by_name_) names.push_back(name);
        document_.refuse(e.at(), "mesh " + shown_quoted(mesh) + " is in no <asset>" + did_you_mean(mesh, names));
      } else if (!found->second.file.empty()) {
        pieces = {{Mesh{found->second.file, found->second.scale}, 0}};
      }
    } else {
      document_.warn(e.at(), "a geom of type " + shown_quoted(type) + " is left out", "geom type");
    }
    if (type != "mesh" && !pieces.empty() && !(volume_m3 > 0))
      return document_.refuse(e.at(), "a geom of type " + type + " needs sizes above 0");
    if (weigh) weigh_geom(e, own, in_link, type, volume_m3, moments);
    add_shapes(e, own, in_link, pieces);
  }

  void weigh_geom(const MjcfElement& e, const Frame& own, const Pose& in_link, const std::string& type,
                  double volume_m3, const Vec3& moments) {
    const double mass_kg = e.has("mass") ? e.number("mass", 0) : e.number("density", density_kg_m3) * volume_m3;
    if (type == "mesh" && (e.has("mass") ? mass_kg > 0 : e.number("density", density_kg_m3) > 0))
      return document_.refuse(e.at(),
                              "link " + shown_quoted(robot_.links[own.link].name) +
                                  " has no <inertial>, and its mesh would give it one: let MuJoCo compile and save the "
                                  "model (mj_saveLastXML), which writes it, or give the geom mass=\"0\"",
                              "mesh inertia");
    if (!(mass_kg > 0)) return;
    weld(own.link, moved(tensor(mass_kg, {moments[0] * mass_kg, moments[1] * mass_kg, moments[2] * mass_kg}), in_link));
  }

  // What collides is drawn where its body has nothing else to be drawn.
  void add_shapes(const MjcfElement& e, const Frame& own, const Pose& in_link,
                  const std::vector<std::pair<Shape, double>>& pieces) {
    UrdfLink& link = robot_.links[own.link];
    UrdfGeometry made{
        .geometry = {.name = e.text("name"), .link = link.name, .pose = in_link}, .mesh_at = e.at(), .file_at = e.at()};
    Material look;
    if (const auto material = materials_.find(e.text("material")); material != materials_.end())
      look = material->second;
    const auto rgba = e.numbers("rgba", 4, 4, {look.rgba.begin(), look.rgba.end()});
    for (std::size_t i = 0; i < 4; ++i) made.geometry.color[i] = std::clamp(rgba[i], 0.0, 1.0);
    const bool collides = e.number("contype", 1) != 0 || e.number("conaffinity", 1) != 0;
    for (const auto& [shape, along] : pieces) {
      UrdfGeometry& added = (collides ? link.collisions : link.visuals).emplace_back(made);
      added.geometry.shape = shape;
      added.geometry.pose = compose(in_link, {{0, 0, along}, {1, 0, 0, 0}});
    }
  }

  // What ties joints together and moves them

  UrdfJoint* joint_named(const std::string& name) {
    const auto found =
        std::ranges::find_if(robot_.joints, [&](const UrdfJoint& joint) { return joint.moves && joint.name == name; });
    return found == robot_.joints.end() ? nullptr : &*found;
  }

  UrdfJoint* joint_of(const MjcfElement& e, const char* attribute) {
    const auto given = e.find(attribute);
    if (!given) return nullptr;
    UrdfJoint* const joint = joint_named(given->text);
    std::vector<std::string> names;
    for (const UrdfJoint& each : robot_.joints)
      if (each.moves) names.push_back(each.name);
    if (joint == nullptr && !refused_joints_.contains(given->text))
      document_.refuse(given->at, "<" + shown(e.name()) + "> is of joint " + shown_quoted(given->text) +
                                      ", which does not exist" + did_you_mean(given->text, names));
    return joint;
  }

  void tendons(const Xml& all) {
    for (const Xml* e = all.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const char* const name = e->Attribute("name");
      std::vector<std::pair<std::string, double>>& parts = tendons_[name == nullptr ? "" : name];
      if (std::string_view(e->Name()) != "fixed") {
        document_.warn(at(*e), "a <" + shown(e->Name()) + "> tendon is left out", "tendon");
        continue;
      }
      each(*e, "joint", [&](const Xml& part) {
        const MjcfElement of = element(part);
        parts.emplace_back(of.text("joint"), of.number("coef", 1));
      });
    }
  }

  void equalities(const Xml& all) {
    for (const Xml* xml = all.FirstChildElement(); xml != nullptr; xml = xml->NextSiblingElement()) {
      const MjcfElement e = element(*xml);
      if (!e.flag("active", true).value_or(true)) continue;
      if (e.name() == "connect" || e.name() == "weld") {
        document_.refuse(e.at(),
                         "<" + shown(e.name()) +
                             "> closes a loop, which no tree of joints has: leave the rod out, and write what drives "
                             "it as a <transmission> of two joints, or its joint as one that mimics another",
                         "closed loop");
        continue;
      }
      if (e.name() != "joint") {
        document_.warn(e.at(), "<" + shown(e.name()) + "> in <equality> is not used", "equality");
        continue;
      }
      UrdfJoint* const follower = joint_of(e, "joint1");
      UrdfJoint* const leader = joint_of(e, "joint2");
      const auto curve = e.numbers("polycoef", 1, 5, {0, 1, 0, 0, 0});
      const bool straight =
          std::all_of(curve.begin() + std::min<std::ptrdiff_t>(2, static_cast<std::ptrdiff_t>(curve.size())),
                      curve.end(), [](double c) { return c == 0; });
      if (follower == nullptr || leader == nullptr || !straight) {
        document_.warn(e.at(),
                       "this <joint> of <equality> is not used: a joint may follow another one along a line alone",
                       "equality");
        continue;
      }
      follower->mimic = UrdfMimic{leader->name, curve.size() > 1 ? curve[1] : 0, curve[0], e.at(), e.at()};
    }
  }

  void actuators(const Xml& all) {
    for (const Xml* xml = all.FirstChildElement(); xml != nullptr; xml = xml->NextSiblingElement()) {
      const MjcfElement e = element(*xml);
      std::vector<std::pair<UrdfJoint*, double>> moved;
      for (const char* const by : {"joint", "jointinparent"}) {
        if (UrdfJoint* const joint = joint_of(e, by)) moved.emplace_back(joint, 1);
      }
      if (const auto tendon = e.find("tendon")) {
        for (const auto& [joint, share] : tendons_[tendon->text]) {
          if (UrdfJoint* const part = joint_named(joint)) moved.emplace_back(part, std::abs(share));
        }
      }
      if (moved.empty()) {
        document_.warn(e.at(), "a <" + shown(e.name()) + "> that moves no joint of the robot is left out", "actuator");
        continue;
      }
      const double most = force_of(e) * std::abs(e.numbers("gear", 1, 6, {1})[0]);
      for (const auto& [joint, share] : moved) joint->joint.effort_max_Nm += share * most;
    }
  }

  // The most that an actuator gives before its gear; infinite when it does not say.
  double force_of(const MjcfElement& e) const {
    const auto larger = [](const std::vector<double>& range) {
      return std::max(std::abs(range[0]), std::abs(range[1]));
    };
    const bool bounded = e.flag("forcelimited").value_or(limits_by_range_ && e.has("forcerange"));
    const double force = bounded ? larger(e.numbers("forcerange", 2, 2, {0, 0})) : infinite;
    const bool direct = e.name() == "motor" || (e.name() == "general" && e.text("biastype", "none") == "none" &&
                                                e.text("gaintype", "fixed") == "fixed");
    const bool commanded = e.flag("ctrllimited").value_or(limits_by_range_ && e.has("ctrlrange"));
    if (!direct || !commanded) return force;
    const double gain = e.name() == "general" ? std::abs(e.numbers("gainprm", 1, 10, {1})[0]) : 1;
    return std::min(force, gain * larger(e.numbers("ctrlrange", 2, 2, {0, 0})));
  }

  // An MJCF without actuators, driven by the program around it, says what its joints' motors give by their ranges.
  void bound_efforts() {
    const bool driven =
        std::ranges::any_of(robot_.joints, [](const UrdfJoint& joint) { return joint.joint.effort_max_Nm > 0; });
    for (UrdfJoint& joint : robot_.joints) {
      double& effort = joint.joint.effort_max_Nm;
      if (const auto most = joint_most_.find(joint.name); most != joint_most_.end() && (effort > 0 || !driven))
        effort = driven ? std::min(effort, most->second) : most->second;
      if (!std::isinf(effort)) continue;
      document_.warn(joint.at,
                     "joint " + shown_quoted(joint.name) +
                         " has an actuator without a limit of force: 100 Nm are assumed; forcerange says it",
                     "no force");
      effort = assumed_force;
    }
  }

  void keyframes(const Xml& all) {
    each(all, "key", [&](const Xml& xml) {
      const MjcfElement e = element(xml);
      if (!e.has("qpos")) return;
      const std::vector<double> q = e.numbers("qpos", 0, 4096, {});
      MjcfPose pose{e.text("name", "key_" + std::to_string(poses_.size())), {}};
      if (q.size() != positions_)
        return document_.warn(e.at(),
                              "<key> " + shown_quoted(pose.name) + " has " + std::to_string(q.size()) +
                                  " positions for " + std::to_string(positions_) + ", and is left out",
                              "key");
      for (const Address& address : addresses_)
        pose.position.emplace_back(address.joint, q[address.at] - address.reference);
      poses_.push_back(std::move(pose));
    });
  }

  UrdfDocument& document_;
  MjcfDefaults defaults_;
  std::vector<MjcfPose>& poses_;
  UrdfDescription robot_;
  bool limits_by_range_ = true, strip_ = false;
  std::optional<bool> from_geoms_;
  std::string meshes_;
  MjcfAngles angles_;
  std::map<std::string, Asset> meshes_by_name_;
  std::map<std::string, Material> materials_;
  std::map<std::string, std::vector<std::pair<std::string, double>>> tendons_;  // joints and their shares
  std::map<std::string, double> joint_most_;                                    // actuatorfrcrange
  std::set<std::string> link_names_, joint_names_, refused_joints_;
  std::vector<Address> addresses_;
  std::size_t positions_ = 0, moving_ = 0;
};

}  // namespace

bool is_mjcf(const std::string& text) {
  const XmlScan scan = scan_xml(SourceText(text));
  return !scan.tags.empty() && scan.tags.front().name == "mujoco";
}

RobotDescription read_mjcf(const std::string& file, const UrdfOptions& options, std::vector<InputProblem>* warnings) {
  return read_mjcf_text(read_input_file(file, description_max_bytes), file, options, warnings);
}

RobotDescription read_mjcf_text(const std::string& text, const std::string& file, const UrdfOptions& options,
                                std::vector<InputProblem>* warnings) {
  const MjcfSource source(text, file);
  try {
    UrdfDocument document(source.text(), file);
    RobotDescription robot;
    UrdfDescription description = MjcfReader(document, robot.poses).run();
    document.throw_if_refused();  // what follows would be consequences
    check_description(document, description, options);
    document.throw_if_refused();
    robot.model = merged(description, document);
    document.throw_if_refused(options.strict);
    robot.model.file = file;
    robot.urdf = urdf_text(description);
    if (warnings != nullptr) *warnings = source.placed(document.warnings());
    return robot;
  } catch (const InputError& error) {
    throw InputError(source.placed(error.problems()));
  }
}

}  // namespace kadans
