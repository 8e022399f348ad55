// The settings of a modelled plant's world: the ground and the objects around the robot.
//
// Every object has a name and a pose. The x axis of the pose gives an object its direction: a ramp and stairs go up
// along it, a wall stands across it, a pendulum hits along it. The friction of a contact is the product of both
// surfaces' friction, its restitution the greater of both (the robot's and the ground's are 0).
//
//   box       pose of its centre; with a mass it moves freely
//   ramp      pose of its lower edge's middle; a slab that rises at incline_rad for length_m, measured along it
//   stairs    pose of the foot of the first step, its middle; each step is rise_m higher and run_m further
//   wall      pose of its foot's middle
//   ball      pose of its centre; rolling_friction_m is the lever arm of rolling resistance
//   pendulum  pose of the bob's centre at rest; a bob on a massless rod, held distance_m behind until release_s
//   ground    a plane through the world's origin that rises at slope_rad towards slope_heading_rad
//   markings  lines painted on that plane, for eyes and pictures alone: no contact knows of them
// Boxes, ramps, stairs, walls and the ground may be driven along a velocity profile; nothing stops them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans {

inline constexpr std::size_t max_world_objects = 32;
inline constexpr std::uint32_t max_stairs = 32;

// A velocity over time, in world axes: linear between the knots, that of the first knot before it, that of the last
// knot after it.
struct MotionSettings {
  struct Knot {
    double time_s = 0;
    Vec3 velocity_m_s{};
  };
  std::vector<Knot> knots;  // times ascend; none: it stands still
  bool repeat = false;      // begins again after the last knot
  bool conveyor = false;    // the surface runs, the object stays where it is

  bool moves() const noexcept { return !knots.empty(); }
};
Vec3 velocity_at(const MotionSettings& motion, double time_s) noexcept;

struct WorldBox {
  Vec3 size_m{};        // full edge lengths
  double mass_kg = 0;   // 0: fixed
  Vec3 velocity_m_s{};  // at the start, of a box with a mass
};
struct WorldRamp {
  double length_m = 0, width_m = 0, incline_rad = 0;
};
struct WorldStairs {
  std::uint32_t count = 0;
  double rise_m = 0, run_m = 0, width_m = 0;
};
struct WorldWall {
  double width_m = 0, height_m = 0, thickness_m = 0;
};
struct WorldBall {
  double radius_m = 0, mass_kg = 0;
  double rolling_friction_m = 0;
  double restitution = 0;  // 0..1
  Vec3 velocity_m_s{};     // at the start
};
struct WorldPendulum {
  double length_m = 0;  // from the hinge to the bob's centre
  double radius_m = 0, mass_kg = 0;
  double distance_m = 0;  // on the level, less than length_m
  double release_s = 0;
};
using WorldShape = std::variant<WorldBox, WorldRamp, WorldStairs, WorldWall, WorldBall, WorldPendulum>;

struct WorldObject {
  std::string name;
  WorldShape shape;
  Pose pose;
  double friction = 1;
  MotionSettings motion;

  // Whether forces move it.
  bool free() const noexcept {
    const auto* box = std::get_if<WorldBox>(&shape);
    return box != nullptr ? box->mass_kg > 0
                          : std::holds_alternative<WorldBall>(shape) || std::holds_alternative<WorldPendulum>(shape);
  }
};

// A point mass fixed to a link for a time. When it is taken up it already has the link's velocity.
struct PayloadSettings {
  std::string name;
  std::string link;
  Vec3 point_m{};  // in the link's frame
  double mass_kg = 0;
  double from_s = 0, until_s = std::numeric_limits<double>::infinity();
};

// Lines and arcs of circles on the ground, all of one width; places are in the plane, x and y from the world's origin.
struct GroundMarkings {
  struct Line {
    std::array<double, 2> from_m{}, to_m{};
  };
  struct Arc {
    std::array<double, 2> center_m{};
    double radius_m = 0;                                 // to the middle of the painted line
    double from_rad = 0, to_rad = 2 * std::numbers::pi;  // from x towards y
  };
  double line_m = 0.05;  // width
  std::vector<Line> lines;
  std::vector<Arc> arcs;
};

struct WorldSettings {
  std::vector<WorldObject> objects;
  std::vector<PayloadSettings> payloads;
  double slope_rad = 0, slope_heading_rad = 0;
  MotionSettings ground_motion;
  std::vector<GroundMarkings> markings;
};

// The boxes that an object is made of: one, stairs one per step; none for a ball or a pendulum.
struct SolidBox {
  Pose pose;  // of its centre
  Vec3 size_m{};
};
std::vector<SolidBox> solid_boxes(const WorldObject& object);
Pose ground_pose(const WorldSettings& world);  // of the plane: z is its normal
// The height of the ground, or of the highest fixed object, at this point.
double surface_height_m(const WorldSettings& world, double x_m, double y_m);

}  // namespace kadans
