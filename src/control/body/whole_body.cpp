// Leads the whole body by tasks, in effort mode: type "whole_body". Tasks are the centre of mass, the feet, the hands,
// the trunk's orientation and the gaze; contacts, torque limits, joint limits, friction and the soles' edges are
// constraints of a quadratic program (body_problem.h), which the high level solves each behavior tick for a robot in
// thought (body_leader.h). The low level leads each joint along what it found:
//
//   u = limit(effort + stiffness (q_ref - q) + damping (v_ref - v), +-effort_max)
//
// with q_ref and v_ref moved on by the time since, and the effort led from the one before to the newest in a period.
//
// Options     left_foot, right_foot: the links that stand; without them the base is fixed. trunk: a link, with feet the
//             base unless it is given. left_hand, right_hand, gaze: links; the gaze's looks along its x axis.
// Set-points  com_x_m ..., foot_left.position_x_m ..., foot_left.roll_rad ..., trunk.roll_rad ..., hand_left_x_m ...,
//             gaze_x_m ... in the task frame (body_model.h), and <joint>.position_rad for the posture, which takes the
//             freedom that the tasks leave. A foot's position is that of the point of its sole below its frame. While
//             it stands, its set-points are where it stands.
//             contact.left and contact.right say whether a foot stands: from 0.5 on. One that shall not stand any more
//             gives its load to the other one within 0.3 s first.
//             tasks: 1: the tasks lead; 0: the joints' set-points alone do, from where the joints are led, and balance
//             is kept. The safe posture sets it. The next motion of a task sets it to 1, with all tasks where they are.
// Parameters  BodySettings, and a JointConfig per joint.
// Signals     the centre of mass as it is led; each foot's load as it is wanted; a State per joint; iterations, status
//             (0 solved, 1 infeasible, 2 iterations exhausted, 3 refused) and the count of failures of the program.
// Start       all tasks are where the robot is; hands and gaze count from their first motion on, until they get the
//             weight 0. Until they count, their set-points are where they are. Torque that the law
//             does not explain fades within 0.2 s after the first solution.
// Not finite  a joint that is not measured gets a torque that is not finite, which the safety layer stops. The start
//             waits until all joints and the base's orientation are measured; until then the torque from before stays.
// Without a solution the robot in thought comes to rest, and the failure is counted.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "body_leader.h"
#include "body_reach.h"
#include "kadans/control/control_object.h"
#include "kadans/control/effort_takeover.h"

namespace kadans {

class WholeBody final : public ControlObject {
 public:
  struct JointConfig {
    double stiffness_Nm_per_rad = 0;  // 0..5000
    double damping_Nms_per_rad = 0;   // 0..500
    double effort_max_Nm = 0;         // 0..the joint's
  };
  struct State {  // of a joint
    double reference_rad = 0, reference_velocity_rad_s = 0;
    double effort_Nm = 0;
    bool saturated = false;
  };

  // Throws std::invalid_argument for a passive joint, OptionError for a link that is not there.
  explicit WholeBody(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  void parameters_changed() noexcept override;
  Foresight* foresight() noexcept override { return &reach_; }
  void pass_state(StateBytes& bytes) noexcept override;
  void hand_overs(HandOvers& all) noexcept override {
    all.down.push_back(&lead_);
    all.up.insert(all.up.end(), {&aim_, &reach_.known()});
  }
  void update(const Snapshot& snapshot) override;

 private:
  struct Part {
    JointAxis axis;
    JointConfig config;
    State state;
    EffortTakeover takeover;
  };
  void declare_task(Declaration& declaration, std::size_t task);
  void declare_weight(Declaration& declaration, std::size_t task);
  void declare_ground(Declaration& declaration);
  void declare_joint(Declaration& declaration, std::size_t i);
  bool locate(const ControlInput& input) noexcept;
  void show(const BodyLead& lead) noexcept;
  void let_lead(bool tasks) noexcept;
  void lead_joint(Part& part, const BodyLead::Joint& to, double age_s, double share, bool known) noexcept;

  BodyLayout layout_;
  BodyLeader leader_;                // behavior thread
  BodyReach reach_;                  // behavior thread
  Handed<BodyLead> draft_;           // behavior thread
  std::int64_t last_update_ns_ = 0;  // behavior thread
  HandDown<BodyLead> lead_;
  HandUp<BodyAim> aim_;
  Kinematics start_;  // control thread, as all below
  std::vector<Part> parts_;
  BodySettings settings_;
  Handed<BodyAim> aimed_;
  bool located_ = false;
  struct Shown {
    Vec3 com_m{};
    std::array<double, body_feet_max> load_N{};
    double iterations = 0, status = 0, failures = 0;
  } shown_;
};

namespace {

constexpr double task_far_m = 5, look_far_m = 50, turn_max_rad = 3.2, pitch_max_rad = 1.5;
constexpr double extrapolate_s = 0.05;  // how far a lead is believed
constexpr const char* points[] = {"x_m", "y_m", "z_m"};
constexpr const char* turns[] = {"roll_rad", "pitch_rad", "yaw_rad"};
constexpr const char* sides[] = {"left", "right"};

bool is_finite(const Quat& q) noexcept { return std::isfinite(q[0] + q[1] + q[2] + q[3]); }

}  // namespace

WholeBody::WholeBody(const ObjectSetup& setup)
    : layout_(setup), leader_(layout_), reach_(layout_), start_(setup.model) {
  for (const JointAxis& axis : layout_.joints)
    parts_.push_back({.axis = axis, .config = {}, .state = {}, .takeover = {}});
}

void WholeBody::declare(Declaration& declaration) {
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) {
    declare_task(declaration, i);
    declare_weight(declaration, i);
  }
  if (layout_.floating) declare_ground(declaration);
  (void)declaration.setpoint({.name = "tasks",
                              .unit = "",
                              .min = 0,
                              .max = 1,
                              .doc = "1: the tasks lead; 0: the joints' own set-points alone do.",
                              .channel = layout_.lead_channel,
                              .joint = no_joint,
                              .safe = 0});
  BodySettings& s = settings_;
  declaration.tunable("effort_share", "", 0.1, 1, s.effort_share, "Share of the torque limits that it plans with.");
  declaration.tunable("velocity_share", "", 0.05, 1, s.velocity_share,
                      "Share of the velocity limits that it plans with.");
  declaration.tunable("posture_weight", "", 1e-5, 100, s.posture_weight,
                      "How much the posture counts beside the tasks.");
  declaration.tunable("posture_per_s", "1/s", 0, 20, s.posture_per_s, "How fast joints go back to the posture.");
  declaration.signal({"iterations", "", "Iterations of the newest program."}, &shown_.iterations);
  declaration.signal(
      {"status", "", "Of the newest program: 0 solved, 1 infeasible, 2 iterations exhausted, 3 refused."},
      &shown_.status);
  declaration.signal({"failures", "", "Programs without a solution since the object was made."}, &shown_.failures);
  for (std::size_t i = 0; i < parts_.size(); ++i) declare_joint(declaration, i);
}

void WholeBody::declare_task(Declaration& declaration, std::size_t index) {
  const BodyTask& task = layout_.tasks[index];
  const bool looks = task.kind == BodyTask::Kind::gaze, foot = task.kind == BodyTask::Kind::foot;
  std::uint32_t channel = task.channel;
  for (std::size_t k = 0; task.has_point() && k < 3; ++k) {
    const SetpointId id = declaration.setpoint(
        {.name = task.name + (foot ? ".position_" : "_") + points[k],
         .unit = "m",
         .min = looks ? -look_far_m : -task_far_m,
         .max = looks ? look_far_m : task_far_m,
         .doc = looks ? "The point to look at, in the task frame." : "Where it shall be, in the task frame.",
         .channel = channel++,
         .joint = no_joint});
    reach_.set_first(id + 1 - channel);  // an object's set-points follow each other
  }
  for (std::size_t k = 0; task.has_turn() && k < 3; ++k) {
    const double most = k == 1 ? pitch_max_rad : turn_max_rad;
    const SetpointId id = declaration.setpoint({.name = task.name + "." + turns[k],
                                                .unit = "rad",
                                                .min = -most,
                                                .max = most,
                                                .doc = "How it shall be turned in the task frame.",
                                                .channel = channel++,
                                                .joint = no_joint});
    reach_.set_first(id + 1 - channel);
  }
}

void WholeBody::declare_weight(Declaration& declaration, std::size_t index) {
  const BodyTask& task = layout_.tasks[index];
  BodySettings::Task& s = settings_.tasks[index];
  declaration.tunable(task.name + ".weight", "", 0, 1000, s.weight, "How much the task counts beside others; 0: not.");
  declaration.tunable(task.name + ".priority", "", 1, 2, s.priority, "1, or 2: gets what tasks of 1 leave.");
  declaration.tunable(task.name + ".gain_per_s", "1/s", 0.5, 20, s.gain_per_s, "How fast its error is corrected.");
  for (std::size_t k = 0; task.kind == BodyTask::Kind::hand && k < 3; ++k) {
    declaration.tunable(task.name + ".point_" + points[k], "m", -1, 1, s.point_m[k], "The hand, in its link's frame.");
  }
}

void WholeBody::declare_ground(Declaration& d) {
  BodySettings& s = settings_;
  for (std::size_t i = 0; i < body_feet_max; ++i) {
    const std::string side = sides[i];
    (void)d.setpoint({.name = "contact." + side,
                      .unit = "",
                      .min = 0,
                      .max = 1,
                      .doc = "1: the foot stands; 0: it gives its load to the other one, and is free.",
                      .channel = layout_.contact_channel + static_cast<std::uint32_t>(i),
                      .joint = no_joint});
    d.signal({"load_" + side + "_N", "N", "What the foot shall bear."}, &shown_.load_N[i]);
  }
  d.tunable("friction", "", 0.05, 2, s.friction, "Friction of the ground that it counts on.");
  d.tunable("toe_m", "m", 0.02, 0.5, s.toe_m, "From a foot's frame forward to the sole's edge.");
  d.tunable("heel_m", "m", 0.02, 0.5, s.heel_m, "From a foot's frame back to the sole's edge.");
  d.tunable("side_m", "m", 0.02, 0.5, s.side_m, "From a foot's frame sideways to the sole's edges.");
  d.tunable("sole_m", "m", 0, 0.5, s.sole_m, "Height of a foot's frame over its sole.");
  d.tunable("edge_m", "m", 0, 0.015, s.edge_m, "How far the centre of pressure stays from the edges.");
  d.tunable("balance_m", "m", 0, 0.05, s.balance_m,
            "How far the centre of mass, and the point over which it comes to rest, stay from the edges.");
  d.tunable("tilt_max_rad", "rad", 0, 3.2, s.tilt_max_rad, "How far the trunk may lean on the way of a motion.");
  d.tunable("passive_Nm_per_rad", "Nm/rad", 0, 1000, s.passive_Nm_per_rad, "Springs in joints without a motor.");
  d.tunable("passive_Nms_per_rad", "Nm s/rad", 0, 100, s.passive_Nms_per_rad, "Dampers in joints without a motor.");
  for (std::size_t k = 0; k < 3; ++k)
    d.signal({std::string("com_") + points[k], "m", "Where the centre of mass is led."}, &shown_.com_m[k]);
}

void WholeBody::declare_joint(Declaration& declaration, std::size_t i) {
  Part& part = parts_[i];
  AxisTables tables(declaration, part.axis, layout_.joint_channel + static_cast<std::uint32_t>(i));
  const double most = part.axis.effort_max_Nm;
  tables.tunable("stiffness_Nm_per_rad", "Nm/rad", 0, 5000, 0, &part.config.stiffness_Nm_per_rad,
                 "Torque per position error.");
  tables.tunable("damping_Nms_per_rad", "Nm s/rad", 0, 500, 0, &part.config.damping_Nms_per_rad,
                 "Torque per velocity error.");
  tables.tunable("effort_max_Nm", "Nm", 0, most, most, &part.config.effort_max_Nm, "Bound of the torque.");
  tables.position_setpoint(0);
  tables.signal("reference_rad", "rad", "Where the joint is led.", &part.state.reference_rad);
  tables.signal("reference_velocity_rad_s", "rad/s", "How fast it is led.", &part.state.reference_velocity_rad_s);
  tables.signal("effort_Nm", "Nm", "Torque asked for.", &part.state.effort_Nm);
  tables.signal("saturated", "", "Whether the torque is limited.", &part.state.saturated);
}

void WholeBody::parameters_changed() noexcept {
  aimed_.settings = settings_;
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) {
    if (layout_.tasks[i].idles() && settings_.tasks[i].weight == 0) aimed_.engaged[i] = false;
  }
  reach_.know(settings_);
}

void WholeBody::start(const ControlInput& input) noexcept {
  ++aimed_.activation;
  aimed_.settings = settings_;
  located_ = locate(input);
  for (Part& part : parts_) {
    const JointState& joint = input.joints.joints[part.axis.joint];
    part.state = {.reference_rad = joint.position_rad};
    part.takeover.start(effort_before_Nm({joint, input.last.joints[part.axis.joint], input.dt_s}));
  }
}

// Puts all tasks where the robot is. False: something is not measured.
bool WholeBody::locate(const ControlInput& input) noexcept {
  const std::size_t count = layout_.model->joints.size();
  for (std::size_t i = 0; i < count; ++i) {
    const JointState& joint = input.joints.joints[i];
    if (!(std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s))) return false;
    aimed_.start_rad[i] = joint.position_rad;
    aimed_.start_rad_s[i] = joint.velocity_rad_s;
  }
  if (layout_.floating && !is_finite(input.status.base.orientation)) return false;
  aimed_.base = layout_.floating ? input.status.base.orientation : Quat{1, 0, 0, 0};
  (void)body_start(layout_, aimed_.settings, start_, {aimed_.start_rad.data(), count}, aimed_.base);
  present_setpoints(layout_, aimed_.settings, start_, aimed_.setpoints);
  for (std::size_t i = 0; i < parts_.size(); ++i)
    aimed_.setpoints[layout_.joint_channel + i] = {.value = aimed_.start_rad[parts_[i].axis.joint]};
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) {
    aimed_.engaged[i] = !layout_.tasks[i].idles();
  }
  aimed_.alone = false;
  return true;
}

void WholeBody::show(const BodyLead& lead) noexcept {
  shown_.com_m = lead.com_m;
  shown_.iterations = lead.iterations;
  shown_.status = lead.status;
  shown_.failures = lead.failures;
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) {
    const BodyTask& task = layout_.tasks[i];
    for (std::uint32_t k = 0; !aimed_.engaged[i] && k < task.channels(); ++k)
      aimed_.setpoints[task.channel + k] = {.value = lead.tasks[i][k]};
  }
  for (std::size_t i = 0; i < layout_.feet.size(); ++i) {
    shown_.load_N[i] = lead.feet[i].load_N;
    for (std::uint32_t k = 0; lead.feet[i].stands && k < 6; ++k)
      aimed_.setpoints[layout_.tasks[layout_.feet[i]].channel + k] = {.value = lead.feet[i].pose[k]};
  }
}

void WholeBody::lead_joint(Part& part, const BodyLead::Joint& to, double age_s, double share, bool known) noexcept {
  State& s = part.state;
  if (!known) {
    s.effort_Nm = 0;
    return;
  }
  s.reference_rad = to.position_rad + age_s * (to.velocity_rad_s + 0.5 * age_s * to.acceleration_rad_s2);
  s.reference_velocity_rad_s = age_s < extrapolate_s ? to.velocity_rad_s + age_s * to.acceleration_rad_s2 : 0;
  s.effort_Nm = to.effort_before_Nm + share * (to.effort_Nm - to.effort_before_Nm);
}

void WholeBody::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  if (!located_) located_ = locate(input);
  const auto newest = lead_.read();
  const BodyLead& lead = *newest;
  const bool known = located_ && lead.activation == aimed_.activation;
  if (known) show(lead);
  if (located_) aim_.publish(aimed_, input.time_ns);
  const double since_s = std::max(0.0, seconds_between(lead.time_ns, input.time_ns));
  const double age_s = std::min(since_s, extrapolate_s), share = std::min(1.0, since_s / lead.period_s);
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    const JointState& joint = input.joints.joints[part.axis.joint];
    lead_joint(part, lead.joints[i], age_s, share, known);
    State& s = part.state;
    const double law_Nm = s.effort_Nm + part.config.stiffness_Nm_per_rad * (s.reference_rad - joint.position_rad) +
                          part.config.damping_Nms_per_rad * (s.reference_velocity_rad_s - joint.velocity_rad_s);
    double effort_Nm = std::numeric_limits<double>::quiet_NaN();
    if (std::isfinite(law_Nm)) {
      const double unlimited_Nm = law_Nm + part.takeover.step(law_Nm, known, input.dt_s);
      effort_Nm = std::clamp(unlimited_Nm, -part.config.effort_max_Nm, part.config.effort_max_Nm);
      s.saturated = effort_Nm != unlimited_Nm;
      part.takeover.leave(effort_Nm);
    }
    s.effort_Nm = effort_Nm;
    actuation.joints[part.axis.joint] = {.effort_Nm = effort_Nm, .mode = ActuationMode::effort};
  }
}

bool WholeBody::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  return state = aimed_.setpoints[channel], true;
}

void WholeBody::follow(std::uint32_t channel, const SetpointState& state) noexcept {
  if (channel == layout_.lead_channel) return let_lead(state.value > 0.5);
  if (channel < layout_.contact_channel) let_lead(true);
  aimed_.setpoints[channel] = state;
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) {
    const BodyTask& task = layout_.tasks[i];
    if (channel >= task.channel && channel < task.channel + task.channels()) aimed_.engaged[i] = true;
  }
}

// Nothing changes while it is as asked.
void WholeBody::let_lead(bool tasks) noexcept {
  if (tasks != aimed_.alone) return;
  aimed_.alone = !tasks;
  aimed_.setpoints[layout_.lead_channel] = {.value = tasks ? 1.0 : 0.0};
  for (std::size_t i = 0; i < layout_.tasks.size(); ++i) aimed_.engaged[i] = tasks && !layout_.tasks[i].idles();
  for (std::size_t i = 0; i < parts_.size(); ++i)
    aimed_.setpoints[layout_.joint_channel + i] = {.value = parts_[i].state.reference_rad};
}

void WholeBody::update(const Snapshot& snapshot) {
  const auto newest = aim_.read();
  const BodyAim& aim = *newest;
  if (aim.activation == 0) return;
  if (aim.activation != draft_.activation) leader_.begin(aim);
  const double since_s = seconds_between(last_update_ns_, snapshot.time_ns);
  last_update_ns_ = snapshot.time_ns;
  draft_.time_ns = snapshot.time_ns;
  leader_.step(aim, std::clamp(since_s, 0.0, extrapolate_s), draft_);
  lead_.publish(draft_);
}

void WholeBody::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.state, part.takeover);
  bytes(aimed_.activation, aimed_.base, aimed_.start_rad, aimed_.start_rad_s, aimed_.setpoints, aimed_.alone,
        aimed_.engaged);
  bytes(located_, shown_);
  bytes.newest(lead_);
  leader_.pass_state(bytes);
  bytes.high_level(draft_, last_update_ns_);
  if (bytes.restores() && located_) aim_.publish(aimed_, decltype(aim_)::out_of_tick);
}

std::unique_ptr<ControlObject> make_whole_body(const ObjectSetup& setup) { return std::make_unique<WholeBody>(setup); }

}  // namespace kadans
