// One joint's drive: what is commanded, what the motor can give, and what reaches the joint.
//
// Motor. Torque is limited to torque_max, and in the direction of motion by the speed-torque line: full torque up to
// the knee velocity, falling linearly to nothing at velocity_max; braking torque is torque_max at any speed. Near the
// line the torque follows the line implicitly, so that a light joint settles on it instead of chattering.
//
// Rigid drive (no spring). The reflected rotor inertia, the friction and the parallel spring and damper act on the
// joint through rows (joint_rows.h); so do position and velocity mode. Effort mode alone is a plain joint torque.
//
// Series elastic drive. The rotor is a state of its own, integrated here, and only the spring's torque
//     T = k (rotor - joint) + c (rotor velocity - joint velocity)
// reaches the joint. Velocities are advanced before positions (symplectic Euler), on both sides of the spring, which
// keeps its energy; the motor's own terms are implicit. Stable while dt^2 k (1/J_rotor + 1/J_joint) < 4 and dt c
// (1/J_rotor + 1/J_joint) < 2. When only the rotor needs them, the rotor takes smaller steps while the joint moves on
// at its velocity; the mean of T acts on the joint.
// Parallel spring and damper act on the joint, always as an implicit row.
#pragma once

#include "joint_rows.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/settings.h"
#include "kadans/signal/state_hash.h"

namespace kadans::bullet {

// Torque as a function of the velocity v at the step's end: clamp(at_rest - slope v, lower, upper).
struct TorqueLaw {
  double at_rest_Nm = 0, slope_Nms_per_rad = 0, lower_Nm = 0, upper_Nm = 0;
};

class Drive {
 public:
  struct State {
    double rotor_rad = 0, rotor_velocity_rad_s = 0;  // of a rigid drive those of its coordinate
    double motor_torque_Nm = 0;                      // electrical: before rotor inertia and friction
    double motor_torque_max_Nm = 0;                  // the most that it could give at its speed, in that direction
    double joint_torque_Nm = 0;                      // what the drive put on the joint in the last step
  };

  // Keeps the rows, which outlive it. URDF damping and friction add to the drive's own.
  Drive(const DriveSettings& settings, const Joint& joint, JointRows& rows, double position_rad);

  void ask(const JointActuation& actuation) noexcept { actuation_ = actuation; }
  void brake(bool braked) noexcept { braked_ = braked; }
  // Sets the rows for this step. Returns the torque to put on the joint beside them.
  double begin_step(double position_rad, double velocity_rad_s, double dt_s);
  void end_step(double position_rad, double velocity_rad_s, double dt_s);

  const State& state() const noexcept { return state_; }
  bool elastic() const noexcept { return settings_.spring_Nm_per_rad > 0; }
  void hash(StateHash& hash) const noexcept;

 private:
  TorqueLaw law(double position_rad, double velocity_rad_s, double dt_s) const;
  double begin_rigid(double position_rad, double velocity_rad_s, double dt_s);
  double begin_elastic(double position_rad, double velocity_rad_s, double dt_s);
  double step_rotor(double position_rad, double velocity_rad_s, double dt_s);
  double available_Nm(double direction, double velocity_rad_s) const;
  double most_Nm(double before_rad_s, double after_rad_s) const;
  double dry_Nm() const noexcept { return settings_.coulomb_Nm + (braked_ ? settings_.brake_Nm : 0); }

  DriveSettings settings_;
  JointRows* rows_;
  JointActuation actuation_;
  State state_;
  double velocity_before_rad_s_ = 0;
  bool braked_ = false;
};

}  // namespace kadans::bullet
