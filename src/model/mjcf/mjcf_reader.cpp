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
#include "kadans/signal/nearest_name.h"
#include "mjcf_motors.h"
#include "mjcf_solid.h"
#include "mjcf_source.h"
#include "mjcf_values.h"
#include "model/urdf/urdf_description.h"
#include "signal/input_file.h"
#include "signal/number_text.h"
#include "urdf_text.h"

namespace kadans {
namespace {

using Xml = tinyxml2::XMLElement;

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double density_kg_m3 = 1000;  // MuJoCo's default
constexpr std::size_t most_bodies = 1000;

class MjcfReader {
 public:
  MjcfReader(UrdfDocument& document, const UrdfOptions& options, std::vector<MjcfPose>& poses)
      : document_(document), options_(options), defaults_(document), poses_(poses) {}

  UrdfDescription run() {
    const Xml& root = document_.root();
    if (std::string_view(root.Name()) != "mujoco")
      document_.stop(tag_at(root), "the first element is <" + shown(root.Name()) + ">, an MJCF's is <mujoco>");
    each_child(root, "compiler", [&](const Xml& e) { compiler(e); });
    each_child(root, "default", [&](const Xml& e) { defaults_.read(e); });
    each_child(root, "asset", [&](const Xml& e) { assets(e); });
    document_.throw_if_refused();
    name_robot(root);
    world(root);
    if (robot_.links.empty()) document_.stop(tag_at(root), "this MJCF has no body with a joint, so it has no robot");
    if (total_mass_kg_ > 0) scale_masses();
    read_mjcf_motors(document_, defaults_, {limits_by_range_, joint_most_}, robot_);
    each_child(root, "keyframe", [&](const Xml& e) { keyframes(e); });
    tell_unused(root);
    return std::move(robot_);
  }

 private:
  struct Frame {           // of what a body holds
    std::size_t link = 0;  // of the description
    Pose in_link;          // of the body's frame
    std::string of_class;
  };
  struct Asset {
    std::string file;
    Vec3 scale{1, 1, 1};
    MeshWeight weight = MeshWeight::legacy;
    bool in_its_frame = true, weighed = false;
    Inertia inertia{};  // at a density of 1 kg/m3
    std::string why_not{};
  };
  struct Address {  // in qpos
    std::string joint;
    std::size_t at = 0;
    double reference = 0;
  };

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
    exact_meshes_ = e.flag("exactmeshinertia", exact_meshes_).value_or(false);
    const auto groups = e.numbers("inertiagrouprange", 2, 2, {weighed_groups_[0], weighed_groups_[1]});
    weighed_groups_ = {groups[0], groups[1]};
    total_mass_kg_ = e.number("settotalmass", total_mass_kg_);
    if (total_mass_kg_ > 0) total_mass_at_ = e.at();
  }

  void name_robot(const Xml& root) {
    const char* const name = root.Attribute("model");
    robot_.name = name == nullptr || read_value(UrdfValue::name, name, nullptr)
                      ? std::filesystem::path(document_.file()).stem().string()
                      : name;
  }

  void assets(const Xml& all) {
    each_child(all, "mesh", [&](const Xml& xml) {
      const MjcfElement e = element(xml);
      std::filesystem::path file = e.text("file");
      if (strip_) file = file.filename();
      const std::string name = e.text("name", file.stem().string());
      if (file.empty())
        document_.warn(e.at(), "mesh " + shown_quoted(name) + " is given by its vertices, and is left out",
                       "mesh of vertices");
      const std::string weight = e.text("inertia", exact_meshes_ ? "exact" : "legacy");
      const bool placed = e.has("refpos") || e.has("refquat");
      if (placed)
        document_.warn(e.at(), "'refpos' and 'refquat' of mesh " + shown_quoted(name) + " are not used", "refpos");
      meshes_by_name_[name] = {.file = file.empty() ? "" : (std::filesystem::path(meshes_) / file).string(),
                               .scale = vec3(e.numbers("scale", 3, 3, {1, 1, 1})),
                               .weight = weight == "exact" ? MeshWeight::exact : MeshWeight::legacy,
                               .in_its_frame = !placed && (weight == "exact" || weight == "legacy")};
    });
    each_child(all, "material", [&](const Xml& xml) {
      const MjcfElement e = element(xml);
      const std::vector<double> rgba = e.numbers("rgba", 4, 4, {0.7, 0.7, 0.7, 1});
      std::copy(rgba.begin(), rgba.end(), materials_[e.text("name")].begin());
    });
  }

  void tell_unused(const Xml& root) {
    const std::set<std::string_view> silent{"compiler", "option",   "size",     "visual",    "statistic",
                                            "default",  "custom",   "asset",    "worldbody", "tendon",
                                            "equality", "actuator", "keyframe", "sensor",    "include"};
    for (const Xml* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (!silent.contains(e->Name())) document_.warn(tag_at(*e), "<" + shown(e->Name()) + "> is not used");
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
    each_child(root, "worldbody", [&](const Xml& e) {
      collect(e, {}, bodies);
      if (const char* const c = e.Attribute("childclass")) of_class = c;
    });
    std::vector<std::pair<const Xml*, Pose>> moved;
    std::copy_if(bodies.begin(), bodies.end(), std::back_inserter(moved),
                 [](const auto& body) { return is_moved(*body.first); });
    const auto is_free = [&](const auto& body) { return free_motion(*body.first) != nullptr; };
    const std::size_t free = static_cast<std::size_t>(std::ranges::count_if(moved, is_free));
    if (free > 1 || (free == 1 && moved.size() > 1))
      document_.stop(tag_at(*moved[1].first), "several robots stand in this MJCF: give each a file of its own");
    // MuJoCo numbers the positions of all joints, those of scenery too.
    const bool own_root = free == 0 && !moved.empty();  // what is bolted down hangs on a link of this name
    if (own_root) {
      robot_.links.push_back({.name = "world"});
      link_names_.insert("world");
    }
    for (const auto& [body, pose] : bodies) {
      if (!is_moved(*body)) {
        skip_positions(*body);
        has_scenery_ = true;
        if (free_motion(*body) != nullptr)
          document_.warn(tag_at(*body),
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
      document_.refuse(tag_at(e), "<" + shown(name) +
                                      "> makes bodies that are not written down: let MuJoCo compile and save the model "
                                      "(mj_saveLastXML), which writes them");
  }

  // What lets a body of the world move freely: a free joint, or what older files have in its place, slides along x, y
  // and z and a ball, in this order.
  static const Xml* free_motion(const Xml& body) {
    std::string types;
    const Xml* first = nullptr;
    for (const Xml* e = body.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (std::string_view(e->Name()) == "freejoint") return e;
      if (std::string_view(e->Name()) != "joint") continue;
      const char *const type = e->Attribute("type"), *const axis = e->Attribute("axis");
      if (type != nullptr && type == std::string_view("free")) return e;
      if (first == nullptr) first = e;
      types += type == nullptr ? "hinge" : type;
      types += axis == nullptr ? ";" : std::string(" ") + axis + ";";
    }
    return types == "slide 1 0 0;slide 0 1 0;slide 0 0 1;ball;" ? first : nullptr;
  }

  // Its other joints.
  static std::vector<const Xml*> joints_of(const Xml& body) {
    std::vector<const Xml*> all;
    const Xml* const free = free_motion(body);
    const char* const type = free == nullptr ? nullptr : free->Attribute("type");
    const bool in_parts = type != nullptr && type == std::string_view("slide");
    each_child(body, "joint", [&](const Xml& e) {
      if (&e != free && !in_parts) all.push_back(&e);
    });
    return all;
  }

  void skip_positions(const Xml& body) {
    if (free_motion(body) != nullptr) positions_ += 7;
    each_child(body, "body", [&](const Xml& e) { skip_positions(e); });
  }

  std::string name_of(const Xml& body) const {
    const char* const name = body.Attribute("name");
    return name == nullptr || *name == '\0' ? "body_" + std::to_string(robot_.links.size()) : name;
  }

  void body(const Xml& xml, const std::optional<Frame>& parent, const std::string& of_class) {
    if (robot_.links.size() >= most_bodies) document_.stop(tag_at(xml), "more than 1000 bodies");
    const MjcfElement e = element(xml, of_class);
    UrdfLink link{.name = unused_link(name_of(xml)),
                  .at = e.at(),
                  .name_at = UrdfElement(document_, xml).at_value("name"),
                  .inertia_at = e.at()};
    const std::vector<const Xml*> joints = joints_of(xml);
    const Xml* const free = free_motion(xml);
    if (free != nullptr) {
      positions_ += 7;
      if (parent)
        document_.refuse(tag_at(*free),
                         "body " + shown_quoted(link.name) + " is free inside of another body: a robot is one tree");
      if (!joints.empty())
        document_.refuse(tag_at(*joints[0]), "body " + shown_quoted(link.name) + " is free, and has another joint");
    }
    Frame own{robot_.links.size(), {}, e.class_name()};
    if (parent) {
      own = hang(e, *parent, joints, std::move(link));
    } else {
      robot_.links.push_back(std::move(link));
    }
    contents(xml, own);
  }

  std::string unused_link(const std::string& wanted) {
    std::string name = wanted;
    while (!link_names_.insert(name).second) name = wanted + "_" + std::to_string(link_names_.size());
    return name;
  }

  // A body on the one around it. Without a joint it stands fast. MuJoCo lets the joints of a body act one after
  // another, the first one outermost: links without mass stand between them.
  Frame hang(const MjcfElement& body, const Frame& parent, const std::vector<const Xml*>& joints, UrdfLink&& link) {
    if (joints.size() > 1) {
      document_.warn(tag_at(*joints[1]),
                     "body " + shown_quoted(link.name) + " moves on " + std::to_string(joints.size()) +
                         " joints of its own: it hangs on links without mass, one a joint, named " +
                         shown_quoted(link.name + "_JOINT"),
                     "several joints");
    }
    Frame carrier{parent.link, compose(parent.in_link, body.pose(angles_)), body.class_name()};
    for (std::size_t i = 0; i + 1 < joints.size(); ++i) {
      const MjcfElement joint = element(*joints[i], body.class_name());
      UrdfLink between{.name = unused_link(link.name + "_" + joint.text("name", std::to_string(i + 1))),
                       .at = joint.at(),
                       .name_at = joint.at(),
                       .inertia_at = joint.at(),
                       .between_joints = true};
      carrier = join(body, carrier, joints[i], std::move(between));
    }
    return join(body, carrier, joints.empty() ? nullptr : joints.back(), std::move(link));
  }

  // `carrier`: where the body is before the joint moves it. Where it is behind it.
  Frame join(const MjcfElement& body, const Frame& carrier, const Xml* moved_by, UrdfLink&& link) {
    Frame behind{robot_.links.size(), {}, carrier.of_class};
    UrdfJoint joint;
    if (moved_by != nullptr) {
      const Vec3 anchor = vec3(element(*moved_by, carrier.of_class).numbers("pos", 3, 3, {0, 0, 0}));
      joint.joint.origin = compose(carrier.in_link, {anchor, {1, 0, 0, 0}});
      behind.in_link.position_m = {-anchor[0], -anchor[1], -anchor[2]};
    } else {
      joint.joint.origin = carrier.in_link;
    }
    joint.parent = {robot_.links[carrier.link].name, body.at()};
    joint.child = {link.name, body.at()};
    joint.at = joint.name_at = body.at();
    joint.name = joint.child.link + "_fixed";
    joint.moves = moved_by != nullptr;
    if (joint.moves) move(element(*moved_by, carrier.of_class), joint);
    while (!joint_names_.insert(joint.name).second) joint.name += "_" + std::to_string(joint_names_.size());
    joint.joint.name = joint.name;
    robot_.links.push_back(std::move(link));
    robot_.joints.push_back(std::move(joint));
    return behind;
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
    Inertia body;
    body.mass_kg = e.number("mass", 0);
    const auto moments = e.numbers("diaginertia", 3, 3, {0, 0, 0});
    body.xx = moments[0], body.yy = moments[1], body.zz = moments[2];
    if (e.has("fullinertia")) {
      const auto m = e.numbers("fullinertia", 6, 6, {0, 0, 0, 0, 0, 0});
      body.xx = m[0], body.yy = m[1], body.zz = m[2], body.xy = m[3], body.xz = m[4], body.yz = m[5];
    }
    robot_.links[own.link].inertia_at = e.at();
    if (body.mass_kg < 0) document_.refuse(e.at(), "a mass is negative");
    if (body.mass_kg > 0) weld(own.link, moved(body, compose(own.in_link, e.pose(angles_))));
  }

  void scale_masses() {
    if (has_scenery_)
      return document_.refuse(total_mass_at_, "'settotalmass' scales the masses of objects too: write the scaled ones");
    double sum_kg = 0;
    for (const UrdfLink& link : robot_.links) sum_kg += link.inertia ? link.inertia->mass_kg : 0;
    for (UrdfLink& link : robot_.links) {
      if (link.inertia && sum_kg > 0) link.inertia = scaled(*link.inertia, total_mass_kg_ / sum_kg);
    }
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
    const double group = e.number("group", 0);
    weigh = weigh && group >= weighed_groups_[0] && group <= weighed_groups_[1];
    if (type == "mesh") return mesh_geom(e, own, in_link, mesh, weigh);
    const MjcfSolid solid = mjcf_primitive(type, {size[0], size[1], size[2]});
    if (solid.pieces.empty())
      document_.warn(e.at(), "a geom of type " + shown_quoted(type) + " is left out", "geom type");
    else if (!(solid.inertia.mass_kg > 0))
      return document_.refuse(e.at(), "a geom of type " + type + " needs sizes above 0");
    else if (type == "ellipsoid")
      document_.warn(e.at(), "an ellipsoid collides and is drawn as a box", "ellipsoid");
    if (weigh) weigh_geom(e, own, in_link, solid.inertia);
    add_shapes(e, own, in_link, solid.pieces);
  }

  void mesh_geom(const MjcfElement& e, const Frame& own, const Pose& in_link, const std::string& mesh, bool weigh) {
    const auto found = meshes_by_name_.find(mesh);
    if (found == meshes_by_name_.end()) {
      std::vector<std::string> names;
      for (const auto& [name, asset] : meshes_by_name_) names.push_back(name);
      return document_.refuse(e.at(), "mesh " + shown_quoted(mesh) + " is in no <asset>" + did_you_mean(mesh, names));
    }
    Asset& asset = found->second;
    const double weight = e.has("mass") ? e.number("mass", 0) : e.number("density", density_kg_m3);
    if (weigh && weight > 0) {
      if (!asset.weighed) asset.inertia = weighed(asset, asset.why_not);
      asset.weighed = true;
      if (!(asset.inertia.mass_kg > 0))
        return document_.refuse(e.at(),
                                "link " + shown_quoted(robot_.links[own.link].name) +
                                    " has no <inertial>, and its mesh would give it one" + asset.why_not +
                                    ": let MuJoCo compile and save the model (mj_saveLastXML), which writes it, or "
                                    "give the geom mass=\"0\"",
                                "mesh inertia");
      weigh_geom(e, own, in_link, asset.inertia);
    }
    if (!asset.file.empty()) add_shapes(e, own, in_link, {{Mesh{asset.file, asset.scale}, 0}});
  }

  // At a density of 1 kg/m3; without mass when it cannot be weighed, and why not.
  Inertia weighed(const Asset& asset, std::string& why_not) const {
    if (!options_.mesh_triangles || asset.file.empty() || !asset.in_its_frame) return {};
    const auto file = find_urdf_file(asset.file, document_.file(), options_.packages);
    if (!file) {
      why_not = ", but " + shown_quoted(asset.file) + " is not there";
      return {};
    }
    try {
      const std::vector<MeshTriangle> triangles = options_.mesh_triangles(*file);
      if (triangles.empty()) return {};
      const Inertia inertia = mesh_inertia(triangles, asset.scale, asset.weight);
      if (!(inertia.mass_kg > 0)) why_not = ", but " + shown_quoted(asset.file) + " encloses no volume";
      return inertia;
    } catch (const InputError& error) {
      why_not = ", but " + shown_quoted(asset.file) + " " + error.problems().front().message;
      return {};
    }
  }

  // `solid`: at a density of 1 kg/m3.
  void weigh_geom(const MjcfElement& e, const Frame& own, const Pose& in_link, const Inertia& solid) {
    if (!(solid.mass_kg > 0)) return;
    const double share = e.has("mass") ? e.number("mass", 0) / solid.mass_kg : e.number("density", density_kg_m3);
    if (share > 0) weld(own.link, moved(scaled(solid, share), in_link));
  }

  // What collides is drawn where its body has nothing else to be drawn.
  void add_shapes(const MjcfElement& e, const Frame& own, const Pose& in_link,
                  const std::vector<std::pair<Shape, double>>& pieces) {
    UrdfLink& link = robot_.links[own.link];
    UrdfGeometry made{
        .geometry = {.name = e.text("name"), .link = link.name, .pose = in_link}, .mesh_at = e.at(), .file_at = e.at()};
    std::array<double, 4> look{0.7, 0.7, 0.7, 1};
    if (const auto material = materials_.find(e.text("material")); material != materials_.end())
      look = material->second;
    const auto rgba = e.numbers("rgba", 4, 4, {look.begin(), look.end()});
    for (std::size_t i = 0; i < 4; ++i) made.geometry.color[i] = std::clamp(rgba[i], 0.0, 1.0);
    const bool collides = e.number("contype", 1) != 0 || e.number("conaffinity", 1) != 0;
    for (const auto& [shape, along] : pieces) {
      UrdfGeometry& added = (collides ? link.collisions : link.visuals).emplace_back(made);
      added.geometry.shape = shape;
      added.geometry.pose = compose(in_link, {{0, 0, along}, {1, 0, 0, 0}});
    }
  }

  void keyframes(const Xml& all) {
    each_child(all, "key", [&](const Xml& xml) {
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
  const UrdfOptions& options_;
  MjcfDefaults defaults_;
  std::vector<MjcfPose>& poses_;
  UrdfDescription robot_;
  bool limits_by_range_ = true, strip_ = false, exact_meshes_ = false;
  std::array<double, 2> weighed_groups_{0, 5};
  double total_mass_kg_ = -1;  // of the file, with its scenery; < 0: as it stands
  std::size_t total_mass_at_ = 0;
  bool has_scenery_ = false;
  std::optional<bool> from_geoms_;
  std::string meshes_;
  MjcfAngles angles_;
  std::map<std::string, Asset> meshes_by_name_;
  std::map<std::string, std::array<double, 4>> materials_;
  std::map<std::string, double> joint_most_;  // actuatorfrcrange
  std::set<std::string> link_names_, joint_names_;
  std::vector<Address> addresses_;
  std::size_t positions_ = 0, moving_ = 0;
};

}  // namespace

bool is_mjcf(const std::string& text) { return first_element(text) == "mujoco"; }

RobotDescription read_mjcf(const std::string& file, const UrdfOptions& options, std::vector<InputProblem>* warnings) {
  return read_mjcf_text(read_input_file(file, description_max_bytes), file, options, warnings);
}

RobotDescription read_mjcf_text(const std::string& text, const std::string& file, const UrdfOptions& options,
                                std::vector<InputProblem>* warnings) {
  const MjcfSource source(text, file);
  try {
    UrdfDocument document(source.text(), file);
    RobotDescription robot;
    UrdfDescription description = MjcfReader(document, options, robot.poses).run();
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
