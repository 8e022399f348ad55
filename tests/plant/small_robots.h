// Robots small enough that physics has a formula for them.
#pragma once

#include <cstdint>

#include "kadans/plant/bullet/bullet_world.h"

namespace kadans::test {

inline constexpr std::int64_t ms = 1'000'000;  // ns
inline constexpr double g = 9.81;

struct Robot {
  RobotModel model;
  PlantSettings settings;

  DriveSettings& drive(std::size_t joint = 0) { return settings.drives[joint]; }
};

// A free box, lying on the ground.
Robot box(double mass_kg, const Vec3& size_m);

// One link on a fixed base, turning about y; no collision shapes, no gravity, no drive. Zero is the link hanging
// straight down. Its inertia about the joint is inertia_kg_m2, its centre of mass com_m below the joint.
Robot pendulum(double mass_kg, double com_m, double inertia_kg_m2);

// A fixed base with a tilt about y that carries a pan about z, moved by the drives "left" and "right" of a
// differential: left = tilt + pan, right = tilt - pan. Inertia about each axis alone: tilt 0.08, pan 0.02 kg m2. No
// gravity.
Robot neck();

// A chain of free-floating links with skew axes, offset centres of mass and full inertia tensors; no gravity.
Robot tumbling_chain();

// One joint, one mode.
ActuationFrame effort(double effort_Nm);
ActuationFrame position(double position_rad);
ActuationFrame velocity(double velocity_rad_s);
ActuationFrame impedance(double position_rad, double stiffness_Nm_per_rad, double damping_Nms_per_rad);
ActuationFrame both(const JointActuation& first, const JointActuation& second);  // two joints

void run(World& plant, int steps, std::int64_t dt_ns = ms);
std::uint64_t state_hash(const World& plant);

}  // namespace kadans::test
