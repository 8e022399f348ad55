// A spring and a damper between a point of a limb and its reference, in effort mode: type "task_impedance" (Hogan 1985,
// Impedance Control, J. Dyn. Sys. Meas. Control 107, without shaping the inertia; Khatib 1987, IEEE J. Robotics and
// Automation 3(1), for J^T).
//
//   F = K (x_ref - x) + D (v_ref - v), its length limited to force_max
//   u = limit(J^T F + posture (q_start - q) - damping qd + I, +-effort_max)
//
// x is the position of the point, v = J qd its velocity, J its Jacobian, all in the base frame. Each tick computes them
// along the limb's own joints. Passive joints of the limb and joints that other objects drive count for x and v, too.
// The point leaves some motions free (a leg's foot may turn). The springs and dampers of the joints hold these; the
// springs hold the pose of the start, so they also act on the point. Gravity is not compensated: compose with a
// gravity_compensation ("sum").
//
// Options     link: the link that the point belongs to; required.
// Set-points  x_m, y_m, z_m: of the point, in the base frame; reached by a minimum-jerk motion in the time given.
// Parameters  point_x_m, point_y_m, point_z_m: the point in the link's frame (a new point is taken over as at the
//             start); a Config per direction: x.stiffness_N_per_m and so on; force_max_N; a JointConfig per joint.
// Signals     a State per direction, a JointOutput per joint, force_limited.
// Start       the reference is where the point is. Torque that the law does not explain fades within 0.2 s.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops. While any
//             joint of the limb is not measured, the position of the point is unknown: F is 0, and the reference is
//             taken anew afterwards.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "control/option_link.h"
#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/limb_chain.h"

namespace kadans {

class TaskImpedance final : public ControlObject {
 public:
  struct Config {                  // of a direction
    double stiffness_N_per_m = 0;  // 0..50000
    double damping_Ns_per_m = 0;   // 0..5000
  };
  struct State {  // of a direction
    double reference_m = 0;
    double position_m = 0;
    double error_m = 0;
    double force_N = 0;
  };
  struct JointConfig {
    double posture_Nm_per_rad = 0;   // 0..5000
    double damping_Nms_per_rad = 0;  // 0..500
    double effort_max_Nm = 0;        // 0..the joint's
  };
  struct JointOutput {
    double effort_Nm = 0;
    bool saturated = false;
  };

  // Throws std::invalid_argument for a passive joint, a missing or unknown link, and a joint that does not move it.
  explicit TaskImpedance(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  void parameters_changed() noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;

 private:
  struct Direction {
    Config config;
    State state;
    SetpointState reference;
    bool asked = false;  // since the last step
    bool keeps = false;  // it was asked together with a new point: the takeover leaves it
  };
  struct Part {
    JointAxis axis;
    std::size_t segment = 0;  // of the chain
    JointConfig config;
    JointOutput output;
    double posture_rad = 0;
    EffortTakeover takeover;
  };
  void declare_direction(Declaration& declaration, std::size_t direction);
  void declare_joint(Declaration& declaration, Part& part);
  bool measured(const JointStates& joints) const noexcept;
  void take_over_point(const JointStates& joints) noexcept;
  void pull(const JointStates& joints) noexcept;
  double law_Nm(const Part& part, const JointState& joint) const noexcept;

  LimbChain chain_;
  std::vector<Part> parts_;
  std::array<Direction, 3> directions_;
  Vec3 point_in_link_m_{};
  Vec3 point_started_m_{};  // point_in_link_m_ when the reference was taken
  double force_max_N_ = 0;
  bool force_limited_ = false;
  bool located_ = false;  // the reference was taken from a known position of the point
};

namespace {

constexpr double point_max_m = 1;
constexpr const char* direction_names[] = {"x", "y", "z"};

}  // namespace

TaskImpedance::TaskImpedance(const ObjectSetup& setup)
    : chain_(setup.model, required_link(setup, "link", "the link at the limb's end")) {
  const auto segments = chain_.segments();
  for (JointAxis& axis : joint_axes(setup)) {
    const auto moves = [&](const LimbChain::Segment& segment) { return segment.joint == axis.joint; };
    const auto found = std::find_if(segments.begin(), segments.end(), moves);
    if (found == segments.end()) {
      throw OptionError("link", "joint " + axis.name + " does not move link " + *setup.options.find("link"));
    }
    parts_.push_back({.axis = std::move(axis), .segment = static_cast<std::size_t>(found - segments.begin())});
  }
}

void TaskImpedance::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < 3; ++i) declare_direction(declaration, i);
  declaration.parameter({"force_max_N", "N", 0, 5000, 200, "Bound of the force at the point."}, &force_max_N_);
  declaration.signal({"force_limited", "", "Whether the force at the point is limited."}, &force_limited_);
  for (Part& part : parts_) declare_joint(declaration, part);
}

void TaskImpedance::declare_direction(Declaration& declaration, std::size_t direction) {
  const std::string name = direction_names[direction];
  Config& c = directions_[direction].config;
  const State& s = directions_[direction].state;
  const double middle_m = chain_.root_m()[direction], far_m = chain_.reach_m() + point_max_m;
  declaration.setpoint({.name = name + "_m",
                        .unit = "m",
                        .min = middle_m - far_m,
                        .max = middle_m + far_m,
                        .doc = "Where the point shall be, in the base frame.",
                        .channel = static_cast<std::uint32_t>(direction),
                        .joint = no_joint});
  declaration.parameter({"point_" + name + "_m", "m", -point_max_m, point_max_m, 0, "The point, in the link's frame."},
                        &point_in_link_m_[direction]);
  declaration.parameter({name + ".stiffness_N_per_m", "N/m", 0, 50000, 0, "Force per distance from the reference."},
                        &c.stiffness_N_per_m);
  declaration.parameter({name + ".damping_Ns_per_m", "N s/m", 0, 5000, 0, "Force per velocity against the reference."},
                        &c.damping_Ns_per_m);
  declaration.signal({name + ".reference_m", "m", "Where the point is led."}, &s.reference_m);
  declaration.signal({name + ".position_m", "m", "Where the point is, in the base frame."}, &s.position_m);
  declaration.signal({name + ".error_m", "m", "Reference minus position."}, &s.error_m);
  declaration.signal({name + ".force_N", "N", "Force asked for at the point."}, &s.force_N);
}

void TaskImpedance::declare_joint(Declaration& declaration, Part& part) {
  AxisTables tables(declaration, part.axis, 0);
  JointConfig& c = part.config;
  const double most = part.axis.effort_max_Nm;
  tables.tunable("posture_Nm_per_rad", "Nm/rad", 0, 5000, 0, &c.posture_Nm_per_rad, "Spring to the pose of the start.");
  tables.tunable("damping_Nms_per_rad", "Nm s/rad", 0, 500, 0, &c.damping_Nms_per_rad, "Damper of the joint itself.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &c.effort_max_Nm, "Bound of the torque.");
  tables.signal("effort_Nm", "Nm", "Torque asked for.", &part.output.effort_Nm);
  tables.signal("saturated", "", "Whether the torque is limited.", &part.output.saturated);
}

bool TaskImpedance::measured(const JointStates& joints) const noexcept {
  return std::all_of(chain_.segments().begin(), chain_.segments().end(), [&](const LimbChain::Segment& segment) {
    const JointState& joint = joints.joints[segment.joint];
    return std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s);
  });
}

void TaskImpedance::take_over_point(const JointStates& joints) noexcept {
  const Vec3 at = chain_.update(joints, point_in_link_m_);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::exchange(directions_[i].keeps, false)) directions_[i].reference = {.value = at[i]};
  }
  point_started_m_ = point_in_link_m_;
  for (Part& part : parts_) part.posture_rad = joints.joints[part.axis.joint].position_rad;
  located_ = true;
}

void TaskImpedance::start(const ControlInput& input) noexcept {
  located_ = false;
  for (Direction& direction : directions_) direction.asked = direction.keeps = false;
  if (measured(input.joints)) take_over_point(input.joints);
  for (Part& part : parts_) {
    const std::size_t joint = part.axis.joint;
    part.takeover.start(effort_before_Nm({input.joints.joints[joint], input.last.joints[joint], input.dt_s}));
  }
}

void TaskImpedance::parameters_changed() noexcept {
  if (point_in_link_m_ == point_started_m_ || !located_) return;
  located_ = false;
  for (Direction& direction : directions_) direction.keeps = direction.asked;
  // An object that has started in this tick goes on from the torque of its start: its own output is of an earlier time.
  for (Part& part : parts_) {
    if (!part.takeover.pending()) part.takeover.start(part.output.effort_Nm);
  }
}

// The force at the point, in each direction.
void TaskImpedance::pull(const JointStates& joints) noexcept {
  const Vec3 at = chain_.update(joints, point_in_link_m_);
  Vec3 velocity_m_s{};
  for (const LimbChain::Segment& segment : chain_.segments()) {
    for (std::size_t i = 0; i < 3; ++i) {
      velocity_m_s[i] += segment.column_m_per_rad[i] * joints.joints[segment.joint].velocity_rad_s;
    }
  }
  double length2_N2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    State& s = directions_[i].state;
    const Config& c = directions_[i].config;
    const SetpointState& reference = directions_[i].reference;
    s.reference_m = reference.value;
    s.position_m = at[i];
    s.error_m = reference.value - at[i];
    s.force_N = c.stiffness_N_per_m * s.error_m + c.damping_Ns_per_m * (reference.velocity - velocity_m_s[i]);
    length2_N2 += s.force_N * s.force_N;
  }
  force_limited_ = length2_N2 > force_max_N_ * force_max_N_;
  if (!force_limited_) return;
  const double share = force_max_N_ / std::sqrt(length2_N2);
  for (Direction& direction : directions_) direction.state.force_N *= share;
}

double TaskImpedance::law_Nm(const Part& part, const JointState& joint) const noexcept {
  double sum_Nm = part.config.posture_Nm_per_rad * (part.posture_rad - joint.position_rad) -
                  part.config.damping_Nms_per_rad * joint.velocity_rad_s;
  if (!located_) return sum_Nm;
  const Vec3& column = chain_.segments()[part.segment].column_m_per_rad;
  for (std::size_t i = 0; i < 3; ++i) sum_Nm += column[i] * directions_[i].state.force_N;
  return sum_Nm;
}

void TaskImpedance::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const JointStates& joints = input.joints;
  if (!measured(joints)) {
    located_ = false;
    for (Direction& direction : directions_) direction.state.force_N = 0;
  } else {
    if (!located_) take_over_point(joints);
    pull(joints);
  }
  for (Direction& direction : directions_) direction.asked = false;
  for (Part& part : parts_) {
    const JointState& joint = joints.joints[part.axis.joint];
    const double law = law_Nm(part, joint);
    const double unlimited_Nm = law + part.takeover.step(law, true, input.dt_s);
    part.output.effort_Nm = std::clamp(unlimited_Nm, -part.config.effort_max_Nm, part.config.effort_max_Nm);
    part.output.saturated = part.output.effort_Nm != unlimited_Nm;
    actuation.joints[part.axis.joint] = {.effort_Nm = part.output.effort_Nm, .mode = ActuationMode::effort};
  }
}

bool TaskImpedance::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  return state = directions_[channel].reference, true;
}

void TaskImpedance::follow(std::uint32_t channel, const SetpointState& state) noexcept {
  directions_[channel].reference = state;
  directions_[channel].asked = true;
}

void TaskImpedance::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.output, part.posture_rad, part.takeover);
  for (Direction& direction : directions_)
    bytes(direction.state, direction.reference, direction.asked, direction.keeps);
  bytes(point_started_m_, force_limited_, located_);
}

std::unique_ptr<ControlObject> make_task_impedance(const ObjectSetup& setup) {
  return std::make_unique<TaskImpedance>(setup);
}

}  // namespace kadans
