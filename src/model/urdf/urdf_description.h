// The contents of a URDF: its links and joints in the order of the file, fixed joints included, with their places
// (bytes of the text) for messages. A RobotModel is made from a URDF in three steps: read_description reads the
// elements one by one, check_description checks how they fit together, read_urdf (urdf_model.cpp) merges fixed joints.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/model/urdf.h"
#include "urdf_document.h"

namespace kadans {

// A limit of this size says that nobody knew it. As a speed it stays finite, so that it can be multiplied.
inline constexpr double no_limit = 1e6;

inline constexpr std::size_t description_max_bytes = std::size_t{2} << 20U;  // of a file, with what it includes

struct UrdfMaterial {
  std::string name;
  std::optional<std::array<double, 4>> color;
  std::size_t at = 0, name_at = 0;
};

struct UrdfGeometry {
  Geometry geometry;  // in the link's frame
  std::optional<UrdfMaterial> material;
  std::size_t mesh_at = 0, file_at = 0;  // of a mesh
};

struct UrdfLink {
  std::string name;
  std::optional<Inertia> inertia;  // in the link's frame; none: no mass
  std::vector<UrdfGeometry> collisions, visuals;
  std::size_t at = 0, name_at = 0, inertia_at = 0;
  bool between_joints = false;  // of one body: it was told that it has no mass
};

struct UrdfEnd {  // of a joint
  std::string link;
  std::size_t at = 0;
};

struct UrdfMimic {
  std::string joint;
  double multiplier = 1, offset = 0;
  std::size_t at = 0, joint_at = 0;
};

struct UrdfJoint {
  std::string name;
  bool moves = true, floats = false;
  Joint joint;  // without its parent; its origin is in the parent link's frame
  UrdfEnd parent, child;
  std::optional<UrdfMimic> mimic;
  std::size_t at = 0, name_at = 0;
};

struct UrdfTransmission {
  Transmission::Settings settings;  // without its joints, in the order of their roles
  std::vector<std::string> joints;
  std::size_t at = 0;
};

struct UrdfDescription {
  std::string name;
  std::vector<UrdfLink> links;
  std::vector<UrdfJoint> joints;
  std::vector<UrdfTransmission> transmissions;  // those that are not one drive in the joint's own coordinate
};

// At most 1000 links, 1000 joints and max_joints of these that move. Notes in the document what is wrong; throws when
// it makes no sense to read on. What a robot does not need is left out of the description and told: joints that mimic a
// fixed one are fixed, a root that is there to carry a floating joint is gone.
UrdfDescription read_description(UrdfDocument& document);

// One <transmission>, in ROS's old and new form and in Drake's. Its gear and its motor's inertia go to the description.
// Called when all joints are read.
void read_transmission(UrdfDocument& document, const tinyxml2::XMLElement& element, UrdfDescription& robot);

// Notes what does not fit together: names given twice or never defined, two parents, two roots, loops, bodies that move
// but have no mass or an inertia that no body can have, mimics of joints that are missing or mimic each other in a
// ring; meshes that may not collide or are not there. The files of those that are there stand in the description
// afterwards; the others are gone.
void check_description(UrdfDocument& document, UrdfDescription& robot, const UrdfOptions& options);

// The part of it that looks at masses. Names and tree are sound.
void check_masses(UrdfDocument& document, const UrdfDescription& robot);

// What package:// or model:// names; nothing for a name without these.
struct UrdfPackagePath {
  std::string package{}, inside;  // package: "" where the name has one part alone
  bool rooted = false;            // package:///...
};
std::optional<UrdfPackagePath> urdf_package_path(std::string_view name);
// The folder of a package, the likeliest one.
std::optional<std::string> find_urdf_package(const std::string& package, const std::string& urdf_file,
                                             const UrdfPackages& packages);

// The model: fixed joints disappear, what hung on them moves into the parent. The description has been checked.
RobotModel merged(const UrdfDescription& robot, UrdfDocument& document);

}  // namespace kadans
