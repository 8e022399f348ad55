// One joint and its drive, for tests of control objects: enough physics to tell a good law from a bad one, little
// enough that the right answer can be written down.
//
//   rigid    (inertia + rotor) dw/dt = drive - viscous w - coulomb sign(w) - gravity sin(q) + load + push
//   elastic  (spring > 0) the rotor is a body of its own between drive and spring; friction is the rotor's
//
// Joints are integrated in steps of 50 us (semi-implicit Euler, friction implicit: a joint that friction holds stands).
// An actuation acts `delay_ticks` steps after it was written; it takes one tick more to be computed (joint_bench.h).
// An actuation that is not finite is not obeyed: the drive is off.
#pragma once

#include <array>
#include <cstdint>

#include "kadans/plant/plant.h"

namespace kadans::testing {

class OneJointPlant final : public Plant {
 public:
  struct Config {
    double inertia_kg_m2 = 0.1;  // of the link about the joint, > 0
    double rotor_inertia_kg_m2 = 0;
    double viscous_Nms_per_rad = 0;
    double coulomb_Nm = 0;
    double gravity_Nm = 0;  // the link's weight times its lever: its torque when it is level; 0 rad hangs down
    double load_Nm = 0;     // constant, towards larger positions
    double spring_Nm_per_rad = 0, spring_damping_Nms_per_rad = 0;  // between rotor and link; 0: rigid
    std::uint32_t delay_ticks = 0;                                 // 0..max_delay_ticks
    double torque_max_Nm = 100;                                    // the drive gives no more
    double encoder_resolution_rad = 0;                             // 0: continuous
    double position_gain_Nm_per_rad = 0;                           // of the drive's position mode
    double velocity_gain_Nms_per_rad = 0;                          // of its position and velocity modes
    double position_rad = 0;                                       // where it starts, at rest
  };
  struct State {
    double position_rad = 0, velocity_rad_s = 0;              // of the link
    double motor_position_rad = 0, motor_velocity_rad_s = 0;  // of the rotor; the link's own when rigid
    double torque_Nm = 0;                                     // of the drive: mean over the last step
    double first_torque_Nm = 0, last_torque_Nm = 0;           // at its beginning and at its end
    bool saturated = false;                                   // at any time of it
  };
  static constexpr std::uint32_t max_delay_ticks = 63;

  explicit OneJointPlant(const Config& config);  // throws std::invalid_argument naming key, value and range

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void step(std::int64_t dt_ns);
  // A torque on the link for the next step only.
  void push(double torque_Nm) noexcept { push_Nm_ = torque_Nm; }

  const State& state() const noexcept { return state_; }
  const Config& config() const noexcept { return config_; }

 private:
  double drive_Nm(const JointActuation& asked) const noexcept;
  void move_rigid(double drive_Nm, double dt_s) noexcept;
  void move_elastic(double drive_Nm, double dt_s) noexcept;

  Config config_;
  State state_;
  std::array<JointActuation, max_delay_ticks + 1> written_{};  // a ring: the newest at ticks_
  std::uint32_t ticks_ = 0;
  double push_Nm_ = 0;
  std::int64_t time_ns_ = 0;
  std::uint32_t sequence_ = 0;
};

}  // namespace kadans::testing
