// A position loop with an inner velocity loop on each joint, in effort mode: type "joint_cascade". This is the
// classical structure of a servo (Leonhard, Control of Electrical Drives, 3rd ed., ch. 15). Each loop has a limit of
// its own, so the joint never gets a velocity command beyond velocity_max on a long way.
//
//   v_cmd = limit(v_ref + kp (q_ref - q), +-velocity_max)
//   u     = limit(feedforward + inertia a_ref + kv (v_cmd - v) + I, +-effort_max),   dI/dt = ki (v_cmd - v)
//
// The reference's velocity and acceleration come from the motion, never from differences. Only the inner loop
// integrates, and the outer loop cannot wind it up: its command is limited before the integral sees it. The integral
// does not grow in the direction in which u is limited, nor beyond integral_max.
//
// Set-points  <joint>.position_rad, reached by a minimum-jerk motion in the time given.
// Start       the reference continues with the joint's velocity and comes to rest; the integral takes over the torque
//             from before.
#include <algorithm>
#include <memory>

#include "kadans/control/jointwise.h"
#include "kadans/control/position_reference.h"

namespace kadans {

class CascadeLaw : public PositionReference {
 public:
  struct Config {
    double kp_per_s = 0;         // 0..200
    double kv_Nms_per_rad = 0;   // 0..500
    double ki_Nm_per_rad = 0;    // 0..50000: torque per time integral of the velocity error
    double inertia_kg_m2 = 0;    // 0..10: feed-forward of the reference's acceleration
    double velocity_weight = 1;  // 0..1: feed-forward of the reference's velocity
    double feedforward_Nm = 0;   // within +-effort_max of the joint
    double integral_max_Nm = 0;
    double velocity_max_rad_s = 0;
    double effort_max_Nm = 0;
  };
  struct State {
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double error_rad = 0;
    double velocity_command_rad_s = 0;  // of the outer loop, limited
    double integral_Nm = 0;
    double effort_Nm = 0;
    bool velocity_limited = false;
    bool saturated = false;
  };

  explicit CascadeLaw(const JointAxis& axis) : PositionReference(axis) {}
  void declare(AxisTables& tables);
  void start(const Takeover& takeover) noexcept;
  JointActuation step(const JointState& state, double dt_s) noexcept;
  void pass_state(StateBytes& bytes) noexcept {
    PositionReference::pass_state(bytes);
    bytes(state_);
  }

 private:
  double velocity_command(const SetpointState& reference, double position_rad) noexcept;

  Config config_;
  State state_;
};

void CascadeLaw::declare(AxisTables& tables) {
  Config& c = config_;
  const State& s = state_;
  const double most = axis_.effort_max_Nm, fastest = axis_.velocity_max_rad_s;
  tables.tunable("kp_per_s", "1/s", 0, 200, 0, &c.kp_per_s, "Velocity per position error.");
  tables.tunable("kv_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.kv_Nms_per_rad, "Torque per velocity error.");
  tables.tunable("ki_Nm_per_rad", "Nm/rad", 0, 50000, 0, &c.ki_Nm_per_rad, "Growth of torque per velocity error.");
  tables.tunable("inertia_kg_m2", "kg m2", 0, 10, 0, &c.inertia_kg_m2, "Torque per acceleration of the reference.");
  tables.tunable("velocity_weight", "", 0, 1, 1, &c.velocity_weight, "Share of the reference's velocity fed forward.");
  tables.tunable("feedforward_Nm", "Nm", -most, most, 0, &c.feedforward_Nm, "Torque added always.");
  tables.tunable("integral_max_Nm", "Nm", 0, most, most, &c.integral_max_Nm, "Bound of the integral.");
  tables.tunable("velocity_max_rad_s", "rad/s", 0, fastest, fastest, &c.velocity_max_rad_s,
                 "Bound of the velocity that the position loop asks for.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  tables.position_setpoint(0);
  tables.signal("reference_rad", "rad", "Set-point of the position.", &s.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "Its velocity.", &s.reference_velocity_rad_s);
  tables.signal("error_rad", "rad", "Set-point minus position.", &s.error_rad);
  tables.signal("velocity_command_rad_s", "rad/s", "What the position loop asks for.", &s.velocity_command_rad_s);
  tables.signal("integral_Nm", "Nm", "Torque of the integral.", &s.integral_Nm);
  tables.signal("effort_Nm", "Nm", "Torque computed.", &s.effort_Nm);
  tables.signal("velocity_limited", "", "Whether the velocity asked for was limited.", &s.velocity_limited);
  tables.signal("saturated", "", "Whether the torque was limited.", &s.saturated);
}

double CascadeLaw::velocity_command(const SetpointState& reference, double position_rad) noexcept {
  State& s = state_;
  s.reference_rad = reference.value;
  s.reference_velocity_rad_s = reference.velocity;
  s.error_rad = reference.value - position_rad;
  const double wanted_rad_s = config_.velocity_weight * reference.velocity + config_.kp_per_s * s.error_rad;
  s.velocity_command_rad_s = std::clamp(wanted_rad_s, -config_.velocity_max_rad_s, config_.velocity_max_rad_s);
  s.velocity_limited = s.velocity_command_rad_s != wanted_rad_s;
  return s.velocity_command_rad_s;
}

void CascadeLaw::start(const Takeover& takeover) noexcept {
  const JointState& joint = takeover.state;
  state_ = {};
  take_over(takeover);
  state_.effort_Nm = effort_before_Nm(takeover);
  const double velocity_error_rad_s = velocity_command(reference_.state(), joint.position_rad) - joint.velocity_rad_s;
  const double wanted_Nm = state_.effort_Nm - config_.feedforward_Nm - config_.kv_Nms_per_rad * velocity_error_rad_s;
  state_.integral_Nm = std::clamp(wanted_Nm, -config_.integral_max_Nm, config_.integral_max_Nm);
}

JointActuation CascadeLaw::step(const JointState& joint, double dt_s) noexcept {
  const Config& c = config_;
  State& s = state_;
  const SetpointState& reference = reference_.step(dt_s);
  const double velocity_error_rad_s = velocity_command(reference, joint.position_rad) - joint.velocity_rad_s;

  const double unlimited_Nm = c.feedforward_Nm + c.inertia_kg_m2 * reference.acceleration +
                              c.kv_Nms_per_rad * velocity_error_rad_s + s.integral_Nm;
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;

  const double growth_Nm = c.ki_Nm_per_rad * velocity_error_rad_s * dt_s;
  const bool winds_up = s.saturated && growth_Nm * unlimited_Nm > 0;
  if (!winds_up) s.integral_Nm = std::clamp(s.integral_Nm + growth_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  return {.effort_Nm = s.effort_Nm, .mode = ActuationMode::effort};
}

std::unique_ptr<ControlObject> make_joint_cascade(const ObjectSetup& setup) {
  return std::make_unique<Jointwise<CascadeLaw>>(setup);
}

}  // namespace kadans
