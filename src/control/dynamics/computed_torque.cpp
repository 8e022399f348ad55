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
// Start       the reference continues with the joint's motion and comes to rest. Torque that M, h and the reference do
//             not explain goes to the integral when ki > 0; the rest of what the law's torque differs by, or all of it,
//             fades within 0.2 s after the first M and h of this activation.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops; for the
//             other joints it counts as not accelerating. Its reference starts anew when it is measured again. A
//             snapshot that is not finite gives no M and h: the last ones stay, and model_age_s grows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/joint_matrix.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/control/model_state.h"

namespace kadans {

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

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  double motion_remaining_s() const noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;
  void hand_overs(HandOvers& all) noexcept override { all.down.push_back(&data_); }
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
  static double settle(Part& part, double law_Nm, double model_Nm, bool known, double dt_s) noexcept;

  std::vector<Part> parts_;          // control thread
  std::int64_t started_ns_ = 0;      // control thread
  double model_age_s_ = 0;           // control thread
  ModelState model_;                 // behavior thread
  std::int64_t last_update_ns_ = 0;  // behavior thread
  Handed<ModelData> draft_;          // behavior thread
  HandDown<ModelData> data_;
};

namespace {

constexpr double period_max_s = 0.05;  // of the high level, for looking ahead

}  // namespace

// Until the high level has seen the robot the mass matrix is that of all joints at 0, and there is no bias.
ComputedTorque::ComputedTorque(const ObjectSetup& setup) : model_(setup.model) {
  for (JointAxis& axis : joint_axes(setup)) parts_.push_back({.axis = std::move(axis)});
  const Eigen::MatrixXd& mass = model_.dynamics().mass_matrix();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      draft_.mass(i, j) = model_.entry_of(mass, parts_[i].axis.joint, parts_[j].axis.joint);
    }
  }
  data_.publish(draft_);
}

void ComputedTorque::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    AxisTables tables(declaration, parts_[i].axis, static_cast<std::uint32_t>(i));
    declare(tables, parts_[i]);
  }
  declaration.signal({"model_age_s", "s", "Age of the measurement from which mass matrix and bias were computed."},
                     &model_age_s_);
}

void ComputedTorque::declare(AxisTables& t, Part& part) {
  Config& c = part.config;
  const State& s = part.state;
  const double most = part.axis.effort_max_Nm;
  t.tunable("kp_per_s2", "1/s2", 0, 1e6, 0, &c.kp_per_s2, "Acceleration per position error.");
  t.tunable("kd_per_s", "1/s", 0, 1e4, 0, &c.kd_per_s, "Acceleration per velocity error.");
  t.tunable("ki_Nm_per_rads", "Nm/(rad s)", 0, 50000, 0, &c.ki_Nm_per_rads, "Growth of torque per position error.");
  t.tunable("integral_max_Nm", "Nm", 0, most, most, &c.integral_max_Nm, "Bound of the integral.");
  t.tunable("rotor_inertia_kg_m2", "kg m2", 0, 1, 0, &c.rotor_inertia_kg_m2, "The drive's rotor, seen at the joint.");
  t.tunable("viscous_Nms_per_rad", "Nm s/rad", 0, 10, 0, &c.viscous_Nms_per_rad, "Friction that the reference meets.");
  t.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  t.position_setpoint(0);
  t.signal("reference_rad", "rad", "Where the joint is led.", &s.reference_rad);
  t.signal("reference_velocity_rad_s", "rad/s", "How fast it is led.", &s.reference_velocity_rad_s);
  t.signal("error_rad", "rad", "Reference minus position.", &s.error_rad);
  t.signal("acceleration_rad_s2", "rad/s2", "Acceleration asked of the joint.", &s.acceleration_rad_s2);
  t.signal("integral_Nm", "Nm", "Torque of the integral.", &s.integral_Nm);
  t.signal("effort_Nm", "Nm", "Torque asked for.", &s.effort_Nm);
  t.signal("saturated", "", "Whether the torque is limited.", &s.saturated);
}

void ComputedTorque::update(const Snapshot& snapshot) {
  const double since_s = std::clamp(1e-9 * static_cast<double>(snapshot.time_ns - last_update_ns_), 0.0, period_max_s);
  last_update_ns_ = snapshot.time_ns;
  if (!model_.update(snapshot, 0.5 * since_s)) return;
  const Dynamics& dynamics = model_.dynamics();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::size_t joint = parts_[i].axis.joint;
    draft_.bias_Nm[i] = model_.effort_of(dynamics.bias(), joint);
    for (std::size_t j = 0; j <= i; ++j) {
      draft_.mass(i, j) = model_.entry_of(dynamics.mass_matrix(), joint, parts_[j].axis.joint);
    }
  }
  draft_.time_ns = snapshot.time_ns;
  data_.publish(draft_);
}

void ComputedTorque::start(const ControlInput& input) noexcept {
  started_ns_ = input.time_ns;
  for (Part& part : parts_) take_over(part, input);
}

void ComputedTorque::take_over(Part& part, const ControlInput& input) noexcept {
  const JointState& joint = input.joints.joints[part.axis.joint];
  part.running = part.fresh = std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s);
  if (!part.running) return;
  const Takeover takeover{joint, input.last.joints[part.axis.joint], input.dt_s};
  continue_motion(part.reference, joint.position_rad, joint.velocity_rad_s, part.axis);
  part.state.integral_Nm = 0;
  part.takeover.start(effort_before_Nm(takeover));
}

// The acceleration to ask of the joint.
void ComputedTorque::aim(Part& part, const ControlInput& input) noexcept {
  const JointState& joint = input.joints.joints[part.axis.joint];
  const Config& c = part.config;
  State& s = part.state;
  if (!(std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s)))
    part.running = false;
  else if (!part.running)
    take_over(part, input);
  const SetpointState& reference =
      part.running ? part.reference.step(part.fresh ? 0 : input.dt_s) : part.reference.state();
  s.reference_rad = reference.value;
  s.reference_velocity_rad_s = reference.velocity;
  s.error_rad = reference.value - joint.position_rad;
  s.acceleration_rad_s2 =
      reference.acceleration + c.kp_per_s2 * s.error_rad + c.kd_per_s * (reference.velocity - joint.velocity_rad_s);
}

double ComputedTorque::settle(Part& part, double law_Nm, double model_Nm, bool known, double dt_s) noexcept {
  const Config& c = part.config;
  State& s = part.state;
  const double integral_max_Nm = c.ki_Nm_per_rads > 0 ? c.integral_max_Nm : 0;  // what never moves should keep nothing
  const double offset_Nm = part.takeover.step(law_Nm, model_Nm, known, dt_s, s.integral_Nm, integral_max_Nm);
  const double unlimited_Nm = law_Nm + offset_Nm + s.integral_Nm;
  s.effort_Nm = std::clamp(unlimited_Nm, -c.effort_max_Nm, c.effort_max_Nm);
  s.saturated = s.effort_Nm != unlimited_Nm;
  const double growth_Nm = c.ki_Nm_per_rads * s.error_rad * dt_s;
  const bool winds_up = s.saturated && growth_Nm * unlimited_Nm > 0;
  if (!winds_up) s.integral_Nm = std::clamp(s.integral_Nm + growth_Nm, -c.integral_max_Nm, c.integral_max_Nm);
  part.takeover.leave(s.effort_Nm);
  return s.effort_Nm;
}

void ComputedTorque::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const auto newest = data_.read();
  const ModelData& model = *newest;
  const bool known = model.time_ns >= started_ns_;
  model_age_s_ = 1e-9 * static_cast<double>(input.time_ns - (known ? model.time_ns : started_ns_));
  std::array<double, max_joints> acceleration_rad_s2{}, feedback_rad_s2{};
  bool taken_over = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    aim(part, input);
    if (!part.running) continue;
    acceleration_rad_s2[i] = part.state.acceleration_rad_s2;
    feedback_rad_s2[i] = acceleration_rad_s2[i] - part.reference.state().acceleration;
    taken_over = taken_over || part.takeover.due(known);
  }
  const std::array<double, max_joints> inertial_Nm = model.mass.times(acceleration_rad_s2, parts_.size());
  std::array<double, max_joints> feedback_Nm{};  // needed at a takeover alone
  if (taken_over) feedback_Nm = model.mass.times(feedback_rad_s2, parts_.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    double effort_Nm = std::numeric_limits<double>::quiet_NaN();
    if (part.running) {
      const double law_Nm = inertial_Nm[i] + part.config.rotor_inertia_kg_m2 * acceleration_rad_s2[i] +
                            model.bias_Nm[i] + part.config.viscous_Nms_per_rad * part.state.reference_velocity_rad_s;
      const double model_Nm = law_Nm - feedback_Nm[i] - part.config.rotor_inertia_kg_m2 * feedback_rad_s2[i];
      effort_Nm = settle(part, law_Nm, model_Nm, known, part.fresh ? 0 : input.dt_s);
      part.fresh = false;
    }
    actuation.joints[part.axis.joint] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
}

bool ComputedTorque::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  return state = parts_[channel].reference.state(), true;
}

void ComputedTorque::follow(std::uint32_t channel, const SetpointState& state) noexcept {
  parts_[channel].reference.follow(state);
}

double ComputedTorque::motion_remaining_s() const noexcept {
  double remaining_s = 0;
  for (const Part& part : parts_) remaining_s = std::max(remaining_s, part.reference.remaining_s());
  return remaining_s;
}

void ComputedTorque::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.state, part.reference, part.takeover, part.running, part.fresh);
  bytes(started_ns_, model_age_s_);
  bytes.newest(data_);
  bytes.high_level(last_update_ns_);
}

std::unique_ptr<ControlObject> make_computed_torque(const ObjectSetup& setup) {
  return std::make_unique<ComputedTorque>(setup);
}

}  // namespace kadans
