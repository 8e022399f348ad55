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
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "gaze_solver.h"
#include "kadans/control/control_object.h"
#include "kadans/control/handover.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/minimum_jerk.h"
#include "kadans/exchange/latest.h"

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
  Rates draft_;                   // behavior thread
  struct Retry {
    std::int64_t moved_ns = 0;  // when the eyes last came nearer, or were on the target
    bool tried = false, going_back = false;
    Vec3 target_m{};  // the target for which it was tried
  };
  Retry retry_;  // behavior thread
  Latest<Rates> rates_;
  Latest<Aim> aim_;
  GazeSolver start_solver_;  // control thread, as all below
  std::vector<double> start_rad_;
  std::vector<Part> parts_;
  std::array<Direction, 3> directions_;
  GazeSolver::Settings settings_;
  double vor_gain_ = 1;
  Aim aimed_;
  double left_rad_ = 0, right_rad_ = 0;
  bool unreachable_ = false, scaled_ = false, at_limit_ = false;
  bool located_ = false;  // the target is set
  bool fresh_ = false;    // started, not stepped yet
};

std::unique_ptr<ControlObject> make_gaze(const ObjectSetup& setup);

}  // namespace kadans
