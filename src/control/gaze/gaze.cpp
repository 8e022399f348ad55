// Turns two eyes on a neck to a point in space and keeps them there: type "gaze".
//
// The high level runs each behavior tick (100 Hz; high_level_divisor 5 makes it 20 Hz). It computes the velocities of
// all joints from the measured joints and the target (gaze_solver.h). The low level runs each control tick. It
// integrates these velocities to positions, writes them in position mode with the velocity as feed-forward, and lets
// the eyes react at once to the motion of the neck:
//
// clang-format off
//   all joints  dv/dt within +-acceleration_max towards the velocity of the high level; v never above the speed from
//               which the joint can brake before its position limit
//   eyes        v += vor_gain C (v_neck measured - v_neck asked)
//   all joints  dq_ref/dt = v
// clang-format on
//
// C says how the eyes must turn against the neck so that the gaze stays: a vestibulo-ocular reflex that uses the neck's
// own sensors (Shibata et al. 2001, Biomimetic oculomotor control, Adaptive Behavior 9(3-4)). So a push against the
// head, or a neck that lags because its motors are slow, moves the gaze little. The motion of the base is not seen: the
// target moves with the base. The object does not carry the neck's weight: compose with a gravity_compensation ("sum").
//
// A descent from the present pose can end at a position limit where a descent from the middle would not. When the eyes
// come no nearer to the target, the head therefore goes back to its middle once and tries again; after that it stays as
// near as it comes.
//
// Options     head: the link that carries the eyes; left_eye, right_eye: links that look along their x axes. Required.
// Set-points  x_m, y_m, z_m: the target in the base frame, reached by a minimum-jerk motion in the time given; with a
//             time of 0 the target jumps and the eyes make a saccade. x_m_s, y_m_s, z_m_s: the velocity with which the
//             target goes on from there for 0.25 s; then it stops, unless the velocity is set again.
// Parameters  those of GazeSolver: gain_per_s, damping, damping_singular, null_per_s; vor_gain; per joint lead_max_rad
//             and a GazeSolver::JointLaw.
// Signals     the target as it is now; left_error_rad and right_error_rad, as the high level saw them; unreachable: the
//             eyes come no nearer; scaled: speed limits hold the gaze back; at_limit: a joint is at its position limit;
//             a JointState per joint.
// Start       the reference continues from the drives' last set-points in position mode, else from the measured state
//             while the torque from before fades; the target is a point 1 m ahead of the eyes.
// Not finite  a joint that is not measured gets an actuation that is not finite, which the safety layer stops. When the
//             high level has seen no complete measurement for 0.1 s, the joints come to rest and the reflex ends.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "control/option_link.h"
#include "gaze_solver.h"
#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/control/takeover.h"

namespace kadans {

class Gaze final : public ControlObject {
 public:
  struct JointConfig {
    double lead_max_rad = 0;  // 0.001..10: how far the reference may be from the joint
  };
  struct JointState {
    double reference_rad = 0;
    double velocity_rad_s = 0;  // of the reference
  };

  // Throws std::invalid_argument for a passive joint, unknown links and joints that do not move the eyes.
  explicit Gaze(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override;
  void cancel_motion(std::uint32_t channel) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  double motion_remaining_s() const noexcept override;
  void parameters_changed() noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;
  void hand_overs(HandOvers& all) noexcept override {
    all.down.push_back(&rates_);
    all.up.push_back(&aim_);
  }
  void update(const Snapshot& snapshot) override;

 private:
  // From the low level to the high level (Aim), and back (Rates).
  struct Aim {
    std::uint32_t activation = 0;
    GazeSolver::Target target;
    GazeSolver::Settings settings;
    std::array<GazeSolver::JointLaw, gaze_joints_max> laws;
  };
  struct Rates {
    std::uint32_t activation = 0;
    std::int64_t time_ns = 0;
    GazeSolver::Solution solution;
    bool unreachable = false;
  };
  struct Part {
    JointAxis axis;
    bool of_eye = false;
    JointConfig config{};
    GazeSolver::JointLaw law{};
    JointState state{};
    double asked_rad_s = 0;  // of the high level, within acceleration_max
    FadingEffort fading{};
    bool running = false;
  };
  struct Direction {
    MinimumJerk point;
    double went_m = 0;  // the way that the velocity added since the point was set
    double velocity_m_s = 0, velocity_left_s = 0;
  };
  void declare_joint(Declaration& declaration, std::size_t i);
  void declare_target(Declaration& declaration);
  void take_over(Part& part, const ControlInput& input) noexcept;
  void look_ahead(const JointStates& joints) noexcept;
  void move_target(double dt_s) noexcept;
  static double braked(const Part& part, double velocity_rad_s, double dt_s) noexcept;
  static void integrate(Part& part, double velocity_rad_s, double position_rad, double dt_s) noexcept;
  bool stalled(std::int64_t time_ns, const Vec3& target_m) noexcept;
  void go_back() noexcept;
  double reflex_rad_s(std::size_t i, const Rates& rates, const JointStates& joints) const noexcept;

  GazeSolver solver_;             // behavior thread
  std::vector<double> seen_rad_;  // behavior thread
  Handed<Rates> draft_;           // behavior thread
  struct Retry {
    std::int64_t moved_ns = 0;  // when the eyes last came nearer, or were on the target
    bool tried = false, going_back = false;
    Vec3 target_m{};  // the target for which it was tried
  };
  Retry retry_;  // behavior thread
  HandDown<Rates> rates_;
  HandUp<Aim> aim_;
  GazeSolver start_solver_;  // control thread, as all below
  std::vector<double> start_rad_;
  std::vector<Part> parts_;
  std::array<Direction, 3> directions_;
  GazeSolver::Settings settings_;
  double vor_gain_ = 1;
  Handed<Aim> aimed_;
  double left_rad_ = 0, right_rad_ = 0;
  bool unreachable_ = false, scaled_ = false, at_limit_ = false;
  bool located_ = false;  // the target is set
  bool fresh_ = false;    // started, not stepped yet
};

namespace {

constexpr double margin_rad = 0.02;  // of a reference before a position limit

constexpr double ahead_m = 1;            // of the first target
constexpr double far_m = 20;             // no target is farther
constexpr double velocity_max_m_s = 20;  // of the target
constexpr double velocity_holds_s = 0.25;
constexpr double rates_hold_s = 0.1;
constexpr double missed_rad = 0.015;     // from which the target counts as missed ...
constexpr double missed_progress = 0.2;  // ... when the eyes come nearer with less than this share of the gain ...
constexpr std::int64_t missed_ns = 100'000'000;  // ... for so long
constexpr double same_target_m = 0.05;
constexpr double back_per_s = 6;  // how fast the joints go back to the middle
constexpr double back_rad = 0.1;  // where they are near enough to it
constexpr const char* axis_names[] = {"x", "y", "z"};

GazeLinks links_of(const ObjectSetup& setup) {
  return {.head = required_link(setup, "head", "the link that carries the eyes"),
          .left_eye = required_link(setup, "left_eye", "a link that looks along its x axis"),
          .right_eye = required_link(setup, "right_eye", "a link that looks along its x axis")};
}

}  // namespace

Gaze::Gaze(const ObjectSetup& setup)
    : solver_(setup.model, links_of(setup), setup.joints),
      seen_rad_(setup.model.joints.size()),
      start_solver_(solver_),
      start_rad_(setup.model.joints.size()) {
  for (JointAxis& axis : joint_axes(setup)) {
    const std::size_t i = parts_.size();
    parts_.push_back({.axis = std::move(axis), .of_eye = solver_.of_eye(i), .law = solver_.law(i)});
  }
}

void Gaze::declare(Declaration& declaration) {
  declare_target(declaration);
  declaration.parameter({"gain_per_s", "1/s", 0, 100, 15, "How fast the eyes turn to the target."},
                        &settings_.gain_per_s);
  declaration.parameter({"damping", "", 0.001, 1, 0.02, "Damping of the least squares."}, &settings_.damping);
  declaration.parameter({"damping_singular", "", 0.001, 1, 0.1, "The same where the eyes lose a direction."},
                        &settings_.damping_singular);
  declaration.parameter({"null_per_s", "1/s", 0, 50, 4, "How fast the joints are centred while the gaze stays."},
                        &settings_.null_per_s);
  declaration.tunable("vor_gain", "", 0, 1.5, vor_gain_,
                      "Share of the neck's error of velocity that the eyes counter.");
  declaration.signal({"left_error_rad", "rad", "Angle between the left eye and the target."}, &left_rad_);
  declaration.signal({"right_error_rad", "rad", "Angle between the right eye and the target."}, &right_rad_);
  declaration.signal({"unreachable", "", "Whether the eyes come no nearer to the target."}, &unreachable_);
  declaration.signal({"scaled", "", "Whether speed limits hold the gaze back."}, &scaled_);
  declaration.signal({"at_limit", "", "Whether a joint stands at its position limit."}, &at_limit_);
  for (std::size_t i = 0; i < parts_.size(); ++i) declare_joint(declaration, i);
}

void Gaze::declare_target(Declaration& declaration) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = axis_names[i];
    declaration.setpoint({.name = name + "_m",
                          .unit = "m",
                          .min = -far_m,
                          .max = far_m,
                          .doc = "Where the eyes shall look, in the base frame.",
                          .channel = static_cast<std::uint32_t>(i),
                          .joint = no_joint,
                          .own_motion = true});
    declaration.signal({"target_" + name + "_m", "m", "Where the target is, in the base frame."},
                       &aimed_.target.point_m[i]);
    declaration.signal({"target_" + name + "_m_s", "m/s", "How fast the target moves."},
                       &aimed_.target.velocity_m_s[i]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    declaration.setpoint({.name = std::string(axis_names[i]) + "_m_s",
                          .unit = "m/s",
                          .min = -velocity_max_m_s,
                          .max = velocity_max_m_s,
                          .doc = "How fast the target goes on from where it was set, for 0.25 s.",
                          .channel = static_cast<std::uint32_t>(3 + i),
                          .joint = no_joint});
  }
}

void Gaze::declare_joint(Declaration& declaration, std::size_t i) {
  Part& part = parts_[i];
  AxisTables tables(declaration, part.axis, 0);
  const double fastest = part.axis.velocity_max_rad_s;
  tables.tunable("weight", "", 0.01, 1000, part.of_eye ? 1 : 15, &part.law.weight, "How dear the joint's motion is.");
  tables.tunable("centring", "", 0, 10, part.of_eye ? 1 : 0.1, &part.law.centring, "How strongly it is drawn to 0.");
  tables.tunable("velocity_max_rad_s", "rad/s", 0, fastest, fastest, &part.law.velocity_max_rad_s, "Speed limit.");
  tables.tunable("acceleration_max_rad_s2", "rad/s2", 0.1, 10000, part.of_eye ? 2000 : 100,
                 &part.law.acceleration_max_rad_s2, "Limit of the reference's acceleration.");
  tables.tunable("lead_max_rad", "rad", 0.001, 10, 0.3, &part.config.lead_max_rad,
                 "How far the reference may be from the joint.");
  tables.signal("reference_rad", "rad", "Where the joint is led.", &part.state.reference_rad);
  tables.signal("velocity_rad_s", "rad/s", "How fast it is led.", &part.state.velocity_rad_s);
}

void Gaze::parameters_changed() noexcept {
  aimed_.settings = settings_;
  for (std::size_t i = 0; i < parts_.size(); ++i) aimed_.laws[i] = parts_[i].law;
}

void Gaze::start(const ControlInput& input) noexcept {
  located_ = false;
  fresh_ = true;
  ++aimed_.activation;
  parameters_changed();
  look_ahead(input.joints);
  for (Part& part : parts_) take_over(part, input);
}

void Gaze::take_over(Part& part, const ControlInput& input) noexcept {
  const auto& joint = input.joints.joints[part.axis.joint];
  part.running = std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s);
  if (!part.running) return;
  const PositionStart before = position_before({joint, input.last.joints[part.axis.joint], input.dt_s});
  part.state = {.reference_rad = before.position_rad, .velocity_rad_s = before.velocity_rad_s};
  part.asked_rad_s = before.velocity_rad_s;
  part.fading.start(before.effort_Nm);
}

// The first target, where the eyes look; waits until all joints are measured.
void Gaze::look_ahead(const JointStates& joints) noexcept {
  for (std::size_t i = 0; i < start_rad_.size(); ++i) {
    start_rad_[i] = joints.joints[i].position_rad;
    if (!std::isfinite(start_rad_[i])) return;
  }
  const Vec3 point = start_solver_.point_ahead(start_rad_, ahead_m);
  for (std::size_t i = 0; i < 3; ++i) {
    directions_[i] = {};
    directions_[i].point.reset(point[i]);
  }
  located_ = true;
}

void Gaze::move_target(double dt_s) noexcept {
  for (std::size_t i = 0; i < 3; ++i) {
    Direction& d = directions_[i];
    d.velocity_left_s -= dt_s;
    if (!(d.velocity_left_s > 0)) d.velocity_m_s = 0;
    const SetpointState& point = d.point.step(dt_s);
    const double next_m = point.value + d.went_m + dt_s * d.velocity_m_s;
    if (std::abs(next_m) <= far_m)
      d.went_m += dt_s * d.velocity_m_s;
    else
      d.velocity_m_s = 0;
    aimed_.target.point_m[i] = point.value + d.went_m;
    aimed_.target.velocity_m_s[i] = point.velocity + d.velocity_m_s;
  }
}

// What an eye adds because the neck moves otherwise than asked.
double Gaze::reflex_rad_s(std::size_t i, const Rates& rates, const JointStates& joints) const noexcept {
  double sum_rad_s = 0;
  for (std::size_t j = 0; j < parts_.size(); ++j) {
    if (parts_[j].of_eye) continue;
    const double velocity_rad_s = joints.joints[parts_[j].axis.joint].velocity_rad_s;
    sum_rad_s += rates.solution.counter[i][j] * (velocity_rad_s - rates.solution.velocity_rad_s[j]);
  }
  return std::isfinite(sum_rad_s) ? vor_gain_ * sum_rad_s : 0;
}

void Gaze::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const double dt_s = fresh_ ? 0 : input.dt_s;
  fresh_ = false;
  if (!located_) look_ahead(input.joints);
  move_target(dt_s);
  if (located_) aim_.publish(aimed_, input.time_ns);
  const auto newest = rates_.read();
  const Rates& rates = *newest;
  const double age_s = 1e-9 * static_cast<double>(input.time_ns - rates.time_ns);
  const bool led = rates.activation == aimed_.activation && age_s <= rates_hold_s;
  left_rad_ = rates.solution.left_rad;
  right_rad_ = rates.solution.right_rad;
  unreachable_ = rates.unreachable;
  scaled_ = rates.solution.scaled;
  at_limit_ = rates.solution.at_limit;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    Part& part = parts_[i];
    const auto& joint = input.joints.joints[part.axis.joint];
    JointActuation& out = actuation.joints[part.axis.joint];
    if (!(std::isfinite(joint.position_rad) && std::isfinite(joint.velocity_rad_s))) {
      part.running = false;
      out = {.position_rad = std::numeric_limits<double>::quiet_NaN(), .mode = ActuationMode::position};
      continue;
    }
    if (!part.running) take_over(part, input);
    const double change = part.law.acceleration_max_rad_s2 * dt_s;
    const double wanted_rad_s = led ? rates.solution.velocity_rad_s[i] : 0;
    part.asked_rad_s += std::clamp(wanted_rad_s - part.asked_rad_s, -change, change);
    part.asked_rad_s = braked(part, part.asked_rad_s, dt_s);
    const double reflex = led && part.of_eye ? reflex_rad_s(i, rates, input.joints) : 0;
    integrate(part, part.asked_rad_s + reflex, joint.position_rad, dt_s);
    out = {.effort_Nm = part.fading.step(dt_s),
           .position_rad = part.state.reference_rad,
           .velocity_rad_s = part.state.velocity_rad_s,
           .mode = ActuationMode::position};
  }
}

// As fast as it can still stop before its limits.
double Gaze::braked(const Part& part, double velocity_rad_s, double dt_s) noexcept {
  const double a = part.law.acceleration_max_rad_s2, half = 0.5 * a * dt_s;  // what half a tick takes off
  const auto most_rad_s = [a, half](double room_rad) {
    return std::sqrt(half * half + 2 * a * std::max(0.0, room_rad - margin_rad)) - half;
  };
  return std::clamp(velocity_rad_s, -most_rad_s(part.state.reference_rad - part.axis.lower_rad),
                    most_rad_s(part.axis.upper_rad - part.state.reference_rad));
}

// Short of the joint's limits, so that a drive that overshoots finds no soft stop, and near where it is; a reference
// that is already beyond comes no farther.
void Gaze::integrate(Part& part, double velocity_rad_s, double position_rad, double dt_s) noexcept {
  JointState& s = part.state;
  const double fastest = part.law.velocity_max_rad_s, lead = part.config.lead_max_rad;
  s.velocity_rad_s = braked(part, std::clamp(velocity_rad_s, -fastest, fastest), dt_s);
  const double lowest = std::max(part.axis.lower_rad + margin_rad, position_rad - lead);
  const double highest = std::min(part.axis.upper_rad - margin_rad, position_rad + lead);
  const double free_rad = s.reference_rad + dt_s * s.velocity_rad_s;
  s.reference_rad = std::clamp(free_rad, std::min(lowest, s.reference_rad), std::max(highest, s.reference_rad));
  if (s.reference_rad != free_rad) s.velocity_rad_s = 0;
}

void Gaze::update(const Snapshot& snapshot) {
  for (std::size_t i = 0; i < seen_rad_.size(); ++i) seen_rad_[i] = snapshot.joints.joints[i].position_rad;
  const auto newest = aim_.read();
  const Aim& aim = *newest;
  solver_.settings() = aim.settings;
  for (std::size_t i = 0; i < solver_.size(); ++i) solver_.law(i) = aim.laws[i];
  if (aim.activation == 0 || !solver_.solve(seen_rad_, aim.target, draft_.solution)) return;
  draft_.unreachable = stalled(snapshot.time_ns, aim.target.point_m);
  if (retry_.going_back) go_back();
  draft_.activation = aim.activation;
  draft_.time_ns = snapshot.time_ns;
  rates_.publish(draft_);
}

// Whether the eyes come no nearer. The first time for a target the joints shall go back to the middle.
bool Gaze::stalled(std::int64_t time_ns, const Vec3& target_m) noexcept {
  const GazeSolver::Solution& s = draft_.solution;
  double moved_m = 0;
  for (std::size_t i = 0; i < 3; ++i) moved_m = std::hypot(moved_m, target_m[i] - retry_.target_m[i]);
  if (moved_m > same_target_m) retry_.tried = retry_.going_back = false;
  const bool misses = std::max(s.left_rad, s.right_rad) > missed_rad && s.progress < missed_progress;
  if (!misses || retry_.going_back) retry_.moved_ns = time_ns;
  if (time_ns - retry_.moved_ns >= missed_ns && !retry_.tried) {
    retry_.tried = retry_.going_back = true;
    retry_.target_m = target_m;
  }
  return retry_.going_back || time_ns - retry_.moved_ns >= missed_ns;
}

// All joints towards their middle, as fast as the slowest may.
void Gaze::go_back() noexcept {
  double share = 1, farthest_rad = 0;
  for (std::size_t i = 0; i < solver_.size(); ++i) {
    const double position_rad = seen_rad_[solver_.joint(i)];
    const double velocity_rad_s = draft_.solution.velocity_rad_s[i] = -back_per_s * position_rad;
    farthest_rad = std::max(farthest_rad, std::abs(position_rad));
    if (std::abs(velocity_rad_s) * share > solver_.law(i).velocity_max_rad_s)
      share = solver_.law(i).velocity_max_rad_s / std::abs(velocity_rad_s);
  }
  for (std::size_t i = 0; i < solver_.size(); ++i) draft_.solution.velocity_rad_s[i] *= share;
  if (farthest_rad < back_rad) retry_.going_back = false;
}

void Gaze::set_point(std::uint32_t channel, double value, double duration_s) noexcept {
  Direction& d = directions_[channel % 3];
  if (channel < 3) {
    SetpointState here = d.point.state();
    here.value += d.went_m;
    if (d.went_m != 0) d.point.follow(here);
    d.went_m = 0;
    d.point.move(value, duration_s);
  } else {
    d.velocity_m_s = value;
    d.velocity_left_s = velocity_holds_s;
  }
}

void Gaze::cancel_motion(std::uint32_t channel) noexcept {
  Direction& d = directions_[channel % 3];
  if (channel < 3) d.point.stop(cancel_time_s);
  d.velocity_m_s = 0;
}

bool Gaze::setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept {
  if (channel >= 3) return false;
  state = directions_[channel].point.state();
  state.value += directions_[channel].went_m;
  return true;
}

void Gaze::follow(std::uint32_t channel, const SetpointState& state) noexcept {
  if (channel >= 3) return;
  directions_[channel].went_m = 0;
  directions_[channel].point.follow(state);
}

double Gaze::motion_remaining_s() const noexcept {
  double remaining_s = 0;
  for (const Direction& d : directions_) remaining_s = std::max(remaining_s, d.point.remaining_s());
  return remaining_s;
}

void Gaze::pass_state(StateBytes& bytes) noexcept {
  for (Part& part : parts_) bytes(part.state, part.asked_rad_s, part.fading, part.running);
  bytes(directions_, aimed_, left_rad_, right_rad_, unreachable_, scaled_, at_limit_, located_, fresh_);
  bytes.newest(rates_);
  bytes.high_level(retry_);
  if (bytes.restores() && located_) aim_.publish(aimed_, decltype(aim_)::out_of_tick);
}

std::unique_ptr<ControlObject> make_gaze(const ObjectSetup& setup) { return std::make_unique<Gaze>(setup); }

}  // namespace kadans
