// How a robot that nobody has configured yet stands, and how stiffly its joints must be held for that: what `kadans new
// robot` writes, and what `kadans commission` proposes when it has measured a joint. From the URDF: kinematics, masses,
// shapes, limits of torque.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans {

struct StandingFoot {
  std::size_t link = 0;
  std::string name;                 // left, right; front_left ...; else the link's
  std::array<Vec3, 4> corners_m{};  // of the sole, in the link's frame: heel inner, heel outer, toe inner, toe outer
  std::vector<std::size_t> leg;     // its joints, from the base on
  // What balances it: the joints of the leg that turn about axes that lie, and the sole about the link's frame, along
  // the robot's axes.
  std::vector<std::size_t> bearing;
  double toe_m = 0, heel_m = 0, below_m = 0;
};

struct StandingWheel {
  std::size_t joint = 0;
  double forward = 1;  // the sign of its velocity that rolls the robot along x, or one way; 0: it stands across
};

struct StandingPose {
  std::vector<StandingFoot> feet;     // what carries it
  std::vector<StandingWheel> wheels;  // or these, with casters where it has some
  double width_m = 0;                 // of all soles together, where they are narrowest
  bool held = true;                   // bolted to the world: without feet, or on less than 6 cm, which takes steps
  std::string why_held;               // of one without feet and wheels: a clause
  std::vector<double> stand;          // positions of the joints, rad (m of a slider)
  std::vector<double> low;            // lower, or for a robot that is bolted down a little aside
  double height_m = 0;                // of the base's frame over the ground, in `stand`; clear of it when held
  double com_m = 0;                   // of the centre of mass over the feet's frames, in `stand`

  bool is_wheel(std::size_t joint) const noexcept {
    return std::ranges::find(wheels, joint, &StandingWheel::joint) != wheels.end();
  }
  // What it stands on; nothing when it is held.
  std::span<const StandingFoot> stands_on() const noexcept {
    return held ? std::span<const StandingFoot>() : std::span(feet);
  }
};

// A robot with at least two links at its ends that are the lowest of all, and a base that is well above them, stands on
// these: its feet under their legs, level where the legs have the joints for it, and its centre of mass over their
// middle (damped least squares, Buss 2004). A base on wheels stands as it is, when they and what else is as low carry
// its centre of mass. Any other is bolted down, and stands as near to zero as its limits allow.
StandingPose find_stance(const RobotModel& model);

struct JointHold {
  double stiffness_Nm_per_rad = 0, damping_Nms_per_rad = 0;  // N/m and Ns/m of a slider
  double rotor_inertia_kg_m2 = 0;                            // kg of a slider; the URDF's, or estimated
  double load_Nm_per_rad = 0;                                // how much gravity takes from the stiffness, at most
  bool weak = false;                                         // its delay does not allow 1.2 times the load
};

// What is known of a joint's loop. The delay is that from the tick that computes an effort to the one that reads what
// it did; the low pass is that of the velocity (estimate/velocity_filter.h).
struct JointLoop {
  double inertia_kg_m2 = 0;  // with its rotor; 0: the model's
  double friction_Nm = 0;    // dry
  double delay_s = 0.002, velocity_cutoff_Hz = 100;
};
// The stiffest that this delay allows: half of what it takes to swing, 1/s2 (times the inertia).
double stiffest_per_s2(const JointLoop& loop);

// One a joint; zeros where there is no motor. `loops`: one a joint, or none for those that nobody has measured.
std::vector<JointHold> hold_joints(const RobotModel& model, const StandingPose& stance,
                                   const std::vector<JointLoop>& loops = {});

}  // namespace kadans
