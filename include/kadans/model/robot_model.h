// The robot's description as the rest of Kadans needs it: a tree of rigid links and the moving joints between them.
// Made from URDF by read_urdf (urdf.h): fixed joints are merged into their parents, so every link but the first hangs
// on exactly one moving joint, and joint i moves link i + 1. SI units; frames as in URDF (REP 103): x forward, y left,
// z up, each link's frame at its joint, rotations given as quaternions (w, x, y, z).
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "kadans/model/transmission.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/frames.h"

namespace kadans {

struct Pose {
  Vec3 position_m{};
  Quat orientation{1, 0, 0, 0};
};

// Inertia about the centre of mass, in axes parallel to the link's frame.
struct Inertia {
  double mass_kg = 0;
  Vec3 com_m{};
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;  // kg m2
};

struct Box {
  Vec3 size_m{};  // full edge lengths
};
struct Sphere {
  double radius_m = 0;
};
struct Cylinder {  // along z
  double radius_m = 0, length_m = 0;
};
struct Mesh {  // collides as its convex hull
  std::string file;
  Vec3 scale{1, 1, 1};
  std::vector<Vec3> corners_m{};  // of the hull, scaled; empty: of a visual, or of a mesh that nobody has read
};
using Shape = std::variant<Box, Sphere, Cylinder, Mesh>;

struct Around {
  Vec3 center_m{}, size_m{};
};
// The box around a hull, along the axes of its mesh. The hull has corners.
Around box_around(const Mesh& mesh) noexcept;

struct Geometry {
  std::string name;
  std::string link;  // the URDF link that it was written in, before merging
  Pose pose;         // in the frame of the (merged) link
  Shape shape;
  std::array<double, 4> color{0.7, 0.7, 0.7, 1};  // red, green, blue, opacity; of visuals
};

struct Link {
  std::string name;
  std::vector<std::string> merged;  // names of the URDF links merged into this one by fixed joints
  Inertia inertia;
  std::vector<Geometry> collisions;
  std::vector<Geometry> visuals;
};

enum class JointType : std::uint8_t { revolute, continuous, prismatic };

// position = multiplier * position of `joint` + offset. A joint that mimics has no motor of its own, whatever the URDF
// says of its torque: what the other joint's motor gives moves both.
struct Mimic {
  std::size_t joint = 0;
  double multiplier = 1, offset = 0;
};

struct Joint {
  std::string name;
  JointType type = JointType::revolute;
  std::size_t parent = 0;               // index of the parent link; the child is link (this joint's index + 1)
  Pose origin;                          // joint frame in the parent link's frame
  Vec3 axis{1, 0, 0};                   // unit vector in the joint frame
  double lower_rad = 0, upper_rad = 0;  // end stops; infinite: none, as of continuous joints
  // Within them what the URDF's <safety_controller> asks the controller to keep; infinite: nothing.
  double soft_lower_rad = -std::numeric_limits<double>::infinity();
  double soft_upper_rad = std::numeric_limits<double>::infinity();
  double effort_max_Nm = 0;                         // 0: passive, no motor
  double velocity_max_rad_s = 0;                    // 1e6 stands for no limit
  double damping_Nms_per_rad = 0, friction_Nm = 0;  // <dynamics>
  double rotor_inertia_kg_m2 = 0;                   // of the motor, reflected to the joint by its gear
  std::optional<Mimic> mimic;

  bool passive() const noexcept { return effort_max_Nm == 0; }
};

struct RobotModel {
  std::string name;
  std::string file;                         // the file that it was read from
  std::vector<Link> links;                  // links[0] is the floating base; parents come before children
  std::vector<Joint> joints;                // size() == links.size() - 1, at most max_joints
  std::vector<Transmission> transmissions;  // joints in none have a drive in their own coordinate

  std::optional<std::size_t> find_joint(std::string_view name) const;
  std::optional<std::size_t> find_link(std::string_view name) const;  // merged names too
  std::vector<std::string> joint_names() const;
  std::vector<std::string> drive_names() const;  // by joint; a drive that no transmission names has its joint's name
  // Whether one of the two joints carries the other, as couplings need.
  bool on_one_path(std::size_t joint, std::size_t other) const;
  // The transmission by which this joint moves with another one; nullptr: it has a drive of its own.
  const Transmission* coupling_of(std::size_t joint) const noexcept;
  // Puts the joints that mimic where those that they mimic lead them. position_rad has one value a joint.
  void lead_mimics(std::span<double> position_rad) const noexcept;
  std::vector<std::string> link_names() const;  // merged names too
  double mass_kg() const;
};

ToldFault told(const Fault& fault, const RobotModel& model, std::int64_t time_ns = 0, const std::string& robot = "");

}  // namespace kadans
