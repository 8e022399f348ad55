// Reads URDF as the world writes it. What cannot be simulated as it was meant is refused, with its place and what to
// do: no root, a loop, a parent that does not exist, a moving link that has no mass and carries none, a negative mass,
// crossed limits. Everything else is a warning that says what was made of it. docs/urdf.md.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/signal/input_error.h"

namespace kadans {

using UrdfPackages = std::map<std::string, std::string>;  // folders by the name of a package

// The corners of the convex hull of a mesh, in the file's unit; none: it cannot be read here. Throws InputError on a
// file that is no mesh: that one is left out, with a warning.
using MeshHull = std::function<std::vector<Vec3>(const std::string& file)>;

// The triangles of a mesh, in the file's unit: three corners each, x y z. None: it cannot be read here. Throws
// InputError on a file that is no mesh.
using MeshTriangle = std::array<float, 9>;
using MeshTriangles = std::function<std::vector<MeshTriangle>(const std::string& file)>;

struct UrdfOptions {
  MeshHull mesh_hull{};            // as which meshes collide; without it they have no corners, and collide nowhere
  MeshTriangles mesh_triangles{};  // which weigh bodies of an MJCF; without it, those without <inertial> are refused
  bool strict = false;             // warnings are mistakes
  UrdfPackages packages{};         // where packages are; else see find_urdf_file
};

// Throws InputError (signal/input_error.h) on any mistake: one message with all mistakes that were found, one per line;
// mistakes of one kind are one line. `warnings`, when given, gets oddities and what was made of them, sorted by place.
RobotModel read_urdf(const std::string& file, const UrdfOptions& options = {},
                     std::vector<InputProblem>* warnings = nullptr);
// `file` only names the text in messages, and is where the paths of meshes start from.
RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options = {},
                          std::vector<InputProblem>* warnings = nullptr);

// Names of two links that need not collide with each other.
using LinkPair = std::pair<std::string, std::string>;

// The <disable_collisions> of an SRDF; all else in it is not used. Pairs with links that the robot does not have are
// left out, with a warning. Throws InputError.
std::vector<LinkPair> read_srdf(const std::string& file, const RobotModel& model,
                                std::vector<InputProblem>* warnings = nullptr);

// A file as a URDF names it. A relative name starts from the URDF's folder. In package://NAME/..., NAME is one of
// `packages`, or a package below a folder of ROS_PACKAGE_PATH or AMENT_PREFIX_PATH, or one that has this name, or a
// package.xml that says it, from the URDF's folder up. Nothing when the file is not there.
std::optional<std::string> find_urdf_file(const std::string& name, const std::string& urdf_file,
                                          const UrdfPackages& packages = {});

// The frames of a robot as its URDF names them, for viewers that draw the URDF. Frames on fixed joints, which a
// RobotModel merges away, are among them.
struct UrdfFrame {
  std::string parent, child;         // links
  std::optional<std::size_t> joint;  // the joint of the model that moves it; none: fixed
  Pose origin;                       // in the parent's frame, at position 0
};

// One frame a joint of the URDF, in the order of its names. `model` was read from this text. Throws InputError.
std::vector<UrdfFrame> urdf_frames(const RobotModel& model, const std::string& text);

// The frame's pose in its parent's frame; one position per joint of the model.
Pose frame_pose(const UrdfFrame& frame, const RobotModel& model, std::span<const double> position_rad) noexcept;

}  // namespace kadans
