// Computed torque for many joints together, in effort mode: type "computed_torque" (Luh, Walker and Paul 1980,
// IEEE Trans. AC 25(3); Craig, Introduction to Robotics, 3rd ed. 2005, section 10.5).
//
//   a = qdd_ref + kp (q_ref - q) + kd (qd_ref - qd)
//   u = limit((M(q) + J_rotor) a + h(q, qd) + viscous qd_ref + I, +-effort_max),   dI/dt = ki (q_ref - q)
//
// With the mass matrix M and the bias h (Coriolis, centrifugal and gravity forces) of the robot every joint's error
// obeys e'' + kd e' + kp e = 0, whatever the pose. The high level computes M and h (model/dynamics.h) in about 14 us
// for TULip. It computes them for half of its period ahead, the middle of the time in which they are used. The low
// level takes the newest ones and never waits.
//
// M and h hold for a robot that hangs from its base: limbs in the air, or a robot on a stand. The base is carried
// evenly, with its orientation from the estimator. Where feet bear the robot, its weight is missing in the model and
// the integral has to carry it. Passive joints and joints that other objects drive count as not accelerating.
//
// Set-points  <joint>.position_rad (within the joint's limits), reached by a minimum-jerk motion in the time given.
// Parameters  a Config per joint; gains are those of the error's equation, so kp = w^2 and kd = 2 d w give it the
//             natural frequency w (rad/s) and the damping ratio d.
// Signals     a State per joint, and model_age_s: the time since the measurement that M and h come from, or since the
//             start while they are older than the start.
// Start       the reference continues with the joint's motion and comes to rest. Torque that the law does not explain
//             goes to the integral when ki > 0; else it fades within 0.2 s after the first M and h of this activation.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops; for the
//             other joints it counts as not accelerating. Its reference starts anew when it is measured again. A
//             snapshot that is not finite gives no M and h: the last ones stay, and model_age_s grows.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/joint_matrix.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/exchange/latest.h"

namespace kadans {

class ModelState;

class ComputedTorque final : public ControlObject {
 public:
  struct Config {                    // of a joint
    double kp_per_s2 = 0;            // 0..1e6
    double kd_per_s = 0;             // 0..1e4
    double ki_Nm_per_rads = 0;       // 0..50000
    double integral_max_Nm = 0;      // 0..effort_max
    double rotor_inertia_kg_m2 = 0;  // 0..1, reflected to the joint
    double viscous_Nms_per_rad = 0;  // 0..10
    double effort_max_Nm = 0;        // 0..the joint's
  };
  struct State {  // of a joint
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double error_rad = 0;
    double acceleration_rad_s2 = 0;  // a, asked of the joint
    double integral_Nm = 0;
    double effort_Nm = 0;
    bool saturated = false;
  };

  // Throws std::invalid_argument for a passive joint.
  explicit ComputedTorque(const ObjectSetup& setup);
  ~ComputedTorque() override;

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  double motion_remaining_s() const noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;
  void update(const Snapshot& snapshot) override;

 private:
  // From the high level to the low level: behavior thread -> control thread.
  struct ModelData {
    std::int64_t time_ns = std::numeric_limits<std::int64_t>::min();  // of the state that M and h belong to
    JointMatrix mass;                                                 // kg m2
    std::array<double, max_joints> bias_Nm{};
  };
  struct Part {
    JointAxis axis;
    Config config;
    State state;
    MinimumJerk reference;
    EffortTakeover takeover;
    bool running = false;
    bool fresh = false;  // started, not stepped yet
  };
  static void declare(AxisTables& tables, Part& part);
  static void take_over(Part& part, const ControlInput& input) noexcept;
  static void aim(Part& part, const ControlInput& input) noexcept;
  static double settle(Part& part, double law_Nm, bool known, double dt_s) noexcept;

  std::vector<Part> parts_;            // control thread
  std::int64_t started_ns_ = 0;        // control thread
  double model_age_s_ = 0;             // control thread
  std::unique_ptr<ModelState> model_;  // behavior thread
  std::int64_t last_update_ns_ = 0;    // behavior thread
  ModelData draft_;                    // behavior thread
  Latest<ModelData> data_;
};

std::unique_ptr<ControlObject> make_computed_torque(const ObjectSetup& setup);

}  // namespace kadans
