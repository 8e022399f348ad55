// Makes the robot step when standing can no longer keep it up: type "dcm_step", in effort mode. Meant to be composed
// with "priority" over a posture with dcm_balance. It claims the legs from its first step on, and leaves them alone
// while the robot stands.
//
// StepPlan decides what each foot does; this class computes the torques.
//
// clang-format off
//   stance leg  The hip holds the torso (after SIMBICON, Yin et al. 2007: ACM Trans. Graph. 26(3)): first at the lean
//               that it had before the first step, then more and more upright. The hip also bears the weight beside it.
//               The knee goes to stance_knee_rad. The ankle places the centre of pressure. The ankle's roll is passive:
//               sideways, only the next foothold helps.
//   swing leg   Inverse kinematics of where the foot shall be over the ground, computed through the measured stance leg
//               and attitude; PD on its joints.
//   both bear   The legs go from the angles and speeds of the landing to a stance with the torso upright over the
//               middle between the feet: PD, with the torques that bear each foot's load as feed-forward.
// clang-format on
//
// Joints      of both legs those about z, x and y at the hip, the knee and the ankle about y (leg_parts.h).
// Options     left_foot, right_foot: the links that stand; required. The foot sensors are in this order too.
// Parameters  Config and StepPlan::Config. `enabled`: 0 lets go at once.
// Signals     State of the plan.
// Start       with both feet where they are; no joint is claimed until the first step.
// Given up    when the base leans beyond tilt_max_rad or a measurement is not finite, it lets go of the legs until it
//             is disabled and enabled again.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "dcm_measure.h"
#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "step_plan.h"

namespace kadans {

// Inverse kinematics of a leg, in closed form. The leg has yaw, roll and pitch at the hip, a knee and an ankle pitch.
// The hip's axes meet in one point. With all angles 0 the thigh and the shank hang straight down.
//
// The joints turn about z, x, y, y, y. So a bent knee is positive, and a hip pitch that lifts the thigh forward is
// negative.
enum LegJoint : std::size_t { hip_yaw, hip_roll, hip_pitch, knee, ankle_pitch, leg_joints };
inline constexpr std::array<const char*, leg_joints> leg_joint_names{"hip_yaw", "hip_roll", "hip_pitch", "knee",
                                                                     "ankle_pitch"};

class LegInverse {
 public:
  using Angles = std::array<double, leg_joints>;

  // Finds the joints of the leg that ends at the link `foot` among the axes (leg_parts.h), and the lengths in the
  // model. Throws std::invalid_argument when a joint is missing or turns the other way, when the hip turns about other
  // axes first, or when the knee and the ankle do not lie below the hip.
  LegInverse(const RobotModel& model, const std::vector<JointAxis>& axes, std::size_t foot);

  // The angles that put the ankle at ankle_m, from the hip in the base frame, with the hip turned by yaw_rad and the
  // foot parallel to the base. A place that is too far or too near is moved into reach, along the line from the hip.
  Angles angles(const Vec3& ankle_m, double yaw_rad) const noexcept;
  // Points the leg there, but makes it no longer than that from hip to ankle.
  Angles angles(const Vec3& ankle_m, double yaw_rad, double longest_m) const noexcept;

  const Vec3& hip_m() const noexcept { return hip_m_; }  // in the base frame
  double thigh_m() const noexcept { return thigh_m_; }
  double longest_m() const noexcept { return longest_m_; }  // from hip to ankle with the knee almost straight
  const JointAxis& axis(std::size_t joint) const noexcept { return axes_[joint]; }

 private:
  std::array<JointAxis, leg_joints> axes_;
  Vec3 hip_m_{};
  double thigh_m_ = 0, shank_m_ = 0, longest_m_ = 0, shortest_m_ = 0;
};

// Parameters <part>.kp_Nm_per_rad and <part>.kd_Nms_per_rad of both legs.
struct LegGains {
  std::array<double, leg_joints> kp_Nm_per_rad{}, kd_Nms_per_rad{};
  void declare(Declaration& declaration);
};

// A leg whose joints are led: a spring and a damper to targets, whose rates are low-passed.
struct LedLeg {
  LegInverse inverse;
  LegInverse::Angles target_rad{}, rate_rad_s{};
  LegInverse::Angles effort_Nm{};

  void declare_signals(Declaration& declaration);  // <joint>.target_rad, <joint>.effort_Nm
  void aim(const LegInverse::Angles& target_rad, double rate_max_rad_s, double dt_s) noexcept;
  // Torques to the targets, with this share of kp.
  LegInverse::Angles spring(const LegGains& gains, double share, const ControlInput& input) const noexcept;
};

class DcmStep final : public ControlObject {
 public:
  struct Config {
    double enabled = 0;  // 0..1
    double tilt_max_rad = 0.7;
    double hip_height_m = 0.5;  // over the ankle, while both feet bear
    double stance_knee_rad = 0.5;
    double torso_Nm_per_rad = 250, torso_Nms_per_rad = 15;
    double bears_share = 0.3;    // share of these two, in pitch, while both feet bear
    double lean_s = 0.5;         // time constant with which the torso comes upright
    double weight_share = 0.85;  // share of the weight beside the stance hip that it bears
    double counter_share = 0.8;  // share of the swing hip's torque that the stance hip takes
    double ankle_max_Nm = 16;
    double ankle_smooth_s = 0.005;
    double forward_share = 0.5;  // feed-forward share of the torques that bear the weight, while both feet bear
    double soft_share = 0.6;     // share of kp while both feet bear
    double both_share = 0.1;     // share of the load on a foot below which the other one stands alone
    double seek_m = 0.01;        // how deep a foot that lost the ground searches for it
    double come_s = 0.4;         // time from a landing to the stance
    double carry = 0.7;          // share of the landing's joint speeds that is kept
    LegGains gains{.kp_Nm_per_rad = {150, 300, 300, 300, 180}, .kd_Nms_per_rad = {2, 4, 4, 4, 3}};
  };

  // Throws std::invalid_argument for a joint that is missing, OptionError for a wrong foot.
  explicit DcmStep(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void pass_state(StateBytes& bytes) noexcept override;

  const StepPlan& plan() const noexcept { return plan_; }

 private:
  using Efforts = LegInverse::Angles;
  struct Leg : LedLeg {
    LegInverse::Angles landed_rad{}, landed_rad_s{};
  };

  void declare_plan(Declaration& declaration);
  void declare_signals(Declaration& declaration);
  void let_go(ActuationFrame& actuation) noexcept;
  void enter(StepPlan::Phase phase, const ControlInput& input) noexcept;
  Vec3 hip(std::size_t leg) const noexcept;  // in the heading frame
  Efforts bearing(std::size_t leg, double force_N, const ControlInput& input) const noexcept;
  std::array<double, 2> upright(std::size_t leg, const ControlInput& input) const noexcept;
  LegInverse::Angles reach(std::size_t leg, const Vec3& way_m, const ControlInput& input) const noexcept;
  LegInverse::Angles come_to_stance(std::size_t leg) const noexcept;
  LegInverse::Angles seek_ground(std::size_t leg, const ControlInput& input) const noexcept;
  void swing_torques(const ControlInput& input) noexcept;
  void bearing_torques(const ControlInput& input) noexcept;
  void write(const ControlInput& input, ActuationFrame& actuation) noexcept;

  std::vector<JointAxis> axes_;
  DcmMeasure over_feet_;
  std::array<Leg, 2> legs_;
  double weight_N_;
  Config config_;
  StepPlan::Config plan_config_;
  StepPlan plan_;
  StepPlan::Phase phase_ = StepPlan::Phase::stands;  // of the last tick
  bool given_up_ = false;
  double lean_rad_ = 0;               // wanted forward lean of the torso: from the measured one down to 0
  std::array<double, 2> ankle_Nm_{};  // low-passed
  double alone_ = 0;                  // how much one foot bears alone, 0..1
  double phase_number_ = 0;
};

std::unique_ptr<ControlObject> make_dcm_step(const ObjectSetup& setup);

}  // namespace kadans
