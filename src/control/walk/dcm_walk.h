// Walks: type "dcm_walk", in effort mode. Meant to be composed with "priority" over a posture that stands. It leaves
// the legs alone until it is told to go; from then on it carries the robot, also while that stands.
//
// WalkPlan decides what each foot does; this class computes the torques.
//
// clang-format off
//   stance leg  Bears the robot: a force from the centre of pressure through the centre of mass, as torques of each joint
//               (LegLoad). The force keeps the centre of mass at its height over the foot. The hip also holds the torso, by
//               the attitude that is measured, and takes the swing leg's reaction (SIMBICON, Yin et al. 2007). The
//               ankle places the centre of pressure, as far as the foot bears; its roll is passive. The yaw turns the
//               base to the heading.
//   swing leg   Inverse kinematics of where the foot shall be over the ground, through the measured stance leg and
//               attitude; PD on its joints, and the leg's own weight. The leg lags on a long step: its length is
//               right for where the foot is by now, and the sole level by what hip and knee are. What led the leg's
//               last swings is given ahead (LearntSwing).
//   a landing   moves the load from one leg to the other in shift_s.
//   both bear   After the last step: the load is shared so that xi comes to rest in the middle. The forces of both legs
//               are parallel, so that feet far apart need no friction to stay there.
// clang-format on
//
// Joints      of both legs those about z, x and y at the hip, the knee and the ankle about y (leg_parts.h).
// Options     left_foot, right_foot: the links that stand; required. The foot sensors are in this order too.
// Set-points  forward_m_s, left_m_s, turn_rad_s: the velocity. go: 1 walks, 0 comes to stand; it reads 1 until it
// stands.
//             x_m, y_m, heading_rad: where the base is by joints and IMU; setting one sets it there.
// Parameters  Config and WalkPlan::Config. Their defaults are those of TULip, carried over to this robot by the length
//             of its legs and its mass (similarity.h), and its soles are those that collide.
// Signals     State of the plan.
// Given up    when the base leans beyond tilt_max_rad or a measurement is not finite: it lets go of the legs until `go`
//             is 0.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "control/balance/dcm_measure.h"
#include "control/balance/stance.h"
#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "learnt_swing.h"
#include "led_leg.h"
#include "walk_plan.h"

namespace kadans {

class DcmWalk final : public ControlObject {
 public:
  struct Config {
    double tilt_max_rad = 0.7;
    double height_m = 0.5028;  // of the centre of mass over the foot's frame
    double height_N_per_m = 2718, height_Ns_per_m = 158.4, lift_max = 0.4;
    double lean_rad = 0.02049;                                   // of the torso, forward
    double torso_Nm_per_rad = 100.4, torso_Nms_per_rad = 6.271;  // in pitch
    double level_Nm_per_rad = 194.6, level_Nms_per_rad = 14.49;  // in roll
    double counter_share = 0.2208;                               // of the swing hip's torque that the stance hip takes
    double yaw_grip_m = 0.035;  // largest torque of a bearing leg's yaw, per load; 0: as much as its motor has
    double grip = 0.4;          // largest force along the ground, per load
    double sole_m = 0;          // how far the sole is below a foot's frame
    double slope_s = 0.25;      // time constant with which the ground's slope is learnt
    double slope_max = 0.12;
    double shift_s = 0.02875;  // in which a leg that landed takes the load
    double ankle_smooth_s = 0.003;
    double by_now = 1;  // 1: the swinging leg's length and sole are right for where it is; 0: for where it shall be
    double ankle_by_load = 1;  // 1: a foot that bears half of what it shall has half the torque in its ankle
    double fade_s = 0.006;     // in which the torques of a leg's part pass into those of the next one
    double stand_s = 0.6;      // after the last step, before it lets go
    double learn_share = 0.3;  // of the torque that led a swing: the leg's next one begins with it
    LegGains gains{.kp_Nm_per_rad = {36.46, 382.7, 240, 100, 92.03}, .kd_Nms_per_rad = {2.765, 4, 4, 4, 2}};
  };

  // Throws std::invalid_argument for a joint that is missing or a foot without a sole, OptionError for a wrong foot.
  explicit DcmWalk(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  bool setpoint_state(std::uint32_t channel, SetpointState& state) const noexcept override;
  void follow(std::uint32_t channel, const SetpointState& state) noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;

  const WalkPlan& plan() const noexcept { return plan_; }

 private:
  using Efforts = LegInverse::Angles;
  struct Leg : LedLeg {
    LegLoad load;
    std::array<std::size_t, leg_joints> bearing;  // the joint's place in load.bearings()
    LearntSwing learnt;
    Efforts jump_Nm{};  // by which the torques would have jumped when the leg changed its part
  };

  Leg leg(const ObjectSetup& setup, std::size_t foot) const;
  void declare_plan(const FittedDeclaration& declaration);
  void declare_kick(const FittedDeclaration& declaration);
  void declare_signals(Declaration& declaration);
  void let_go(ActuationFrame& actuation) noexcept;
  WalkPlan::Sight sight(const ControlInput& input) const noexcept;
  void begin(const ControlInput& input) noexcept;
  void reckon(const OdometryStatus& now) noexcept;
  void see_ball() noexcept;
  bool stands() const noexcept;
  void feel_ground(const ControlInput& input) noexcept;
  void landed(const ControlInput& input) noexcept;
  GroundPoint lever(std::size_t leg, double in_sole_x_m) const noexcept;
  Efforts bearing(std::size_t leg, double share, double in_sole_x_m, const GroundPoint& lever_m,
                  const ControlInput& input) noexcept;
  double gripped_Nm(std::size_t leg, double yaw_Nm, const ControlInput& input) const noexcept;
  void turn(const Efforts& swing_Nm, const ControlInput& input) noexcept;
  void swing_torques(const ControlInput& input) noexcept;
  void both_torques(const ControlInput& input) noexcept;
  void write(const ControlInput& input, ActuationFrame& actuation) noexcept;

  std::vector<JointAxis> axes_;
  DcmMeasure over_feet_;
  std::array<Leg, 2> legs_;
  double weight_N_;
  FootShape foot_;
  Similarity similarity_;
  Config config_;
  WalkPlan::Config plan_config_;
  WalkPlan plan_;
  WalkPlan::Wanted wanted_;
  struct Odometry {
    double x_m = 0, y_m = 0, heading_rad = 0;                 // of the base
    double seen_x_m = 0, seen_y_m = 0, seen_heading_rad = 0;  // the robot's own, of the tick before
    std::uint64_t seen_resets = 0;
  };
  Odometry odometry_;
  Kick ball_;          // to be kicked, in the frame of the odometry
  GroundPoint slope_;  // of the ground in the heading frame, per metre, by the attitude of the foot that stands
  bool given_up_ = false, changes_ = false;  // changes: the legs change their parts in this tick
  std::array<double, 2> turn_Nm_{};          // moment of the ground on the robot about its centre of mass: roll, pitch
  std::array<double, 2> ankle_Nm_{};         // low-passed
  double phase_number_ = 0, stance_number_ = 0, com_height_m_ = 0;
};

std::unique_ptr<ControlObject> make_dcm_walk(const ObjectSetup& setup);

}  // namespace kadans
