// Keeps a robot standing on both feet by the forces of its legs on the ground, in effort mode: type "stance". Meant to
// be composed onto a soft posture ("sum").
//
// Four steps lead from the motion of the robot to the torque of each joint. xi is the divergent component of motion
// (dcm_measure.h), c the centre of mass, p the centre of pressure, L the moment that turns the robot about c.
//
// clang-format off
//   pressure  d xi / dt = w0 (xi - p - L / (m g)). p and L have the same effect on xi, so the law is
//             p + L / (m g) = rest + pull (xi - rest). p has to lie within the soles. p_y decides how the feet share
//             the weight. Between two feet side by side the soles reach as far forward as one sole. A foot that is set
//             ahead extends this reach, but only towards that foot.
//   turn      L rights the trunk as far as the soles can make up for it: rest + need (xi - rest) must stay possible.
//             Where the soles do not reach, L bows the trunk in the direction of the fall, which pushes the hips back,
//             and rights it later (Horak and Nashner 1986, J. Neurophysiology 55(6)). The arms swing in proportion to
//             what is wanted beyond the soles.
//   forces    F_x = (F_z (c_x - p_x) - L_y) / c_z, F_y = (F_z (c_y - p_y) + L_x) / c_z: a force through p with the
//             moment L. Friction bounds F_x and F_y. F_z is the weight plus what lifts the robot to its height. The
//             further p is from c, the harder the legs press: more load has the effect of longer soles.
//   torques   Each leg bears its share of F at its own centre of pressure, and its own weight (LegLoad). On a foot
//             that tips, the pressure moves back from the edge.
// clang-format on
//
// A foot stays flat when its ankle gives no more torque than its load can hold. A posture that holds the hips or ankles
// stiffly works against the trunk and the soles: its gains have to be small there. A sole that is pressed to its edge
// without any delay chatters on the ground; smooth_s prevents that.
//
// Joints      of each side, the leg joints that shall bear load, and shoulders that turn about y.
// Options     left_foot, right_foot: the links that stand; required.
// Parameters  Config. `share` fades all torques in and out; a change by 1 takes 0.2 s.
// Signals     State, and <joint>.effort_Nm.
// Start       the torques rise from 0 in 0.2 s.
// Not finite  no torque at all: the posture goes on alone.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "balance_joint.h"
#include "dcm_measure.h"
#include "kadans/control/control_object.h"
#include "kadans/model/kinematics.h"
#include "kadans/model/robot_model.h"
#include "trunk_righting.h"

namespace kadans {

// The joint torques of a leg that bears a load. They balance the force of the ground on the foot and the weight of the
// leg's links (statics of an open chain: the transpose of the leg's Jacobian).
//
// One owner, the control thread. Only the constructor allocates or throws.

class LegLoad {
 public:
  struct Bearing {
    std::size_t joint = 0;  // index in the model
    double effort_Nm = 0;
  };

  // The leg is the joints from the link `foot` up to the base. Keeps a reference to the model.
  LegLoad(const RobotModel& model, std::size_t foot);

  // force_N acts on the foot at point_m. Both are in the frame in which the kinematics have the base's pose; its z axis
  // points up.
  void update(const Kinematics& kinematics, const Vec3& force_N, const Vec3& point_m) noexcept;

  std::span<const Bearing> bearings() const noexcept { return bearings_; }  // from the foot upwards
  bool bears(std::size_t joint) const noexcept;

 private:
  const RobotModel* model_;
  std::vector<Bearing> bearings_;
};

struct StanceState {
  bool follows = false;  // xi is known from the tick before
  double dcm_x_m = 0, dcm_y_m = 0;
  double cop_x_m = 0, cop_y_m = 0;      // p
  double beyond_x_m = 0;                // how far beyond the soles p_x would have to be
  double turn_x_Nm = 0, turn_y_Nm = 0;  // L
  double left = 0;                      // share of the weight on the left foot
  Vec3 force_N{};
  double share = 0;
};

class Stance final : public Balancing<StanceState> {
 public:
  struct Config {
    double share = 0;                       // 0..1
    double offset_x_m = 0, offset_y_m = 0;  // rest: where xi shall be, from the middle between the feet's frames
    double pull_x = 2, pull_y = 2;
    double need = 1.1;                   // the pull that L must leave possible
    double toe_m = 0.12, heel_m = 0.07;  // from a foot's frame to where its pressure may go
    double side_m = 0;                   // how far beyond the feet's frames p_y may go
    double sole_m = 0.06;                // how far the sole is below a foot's frame
    double flat_m_per_rad = 0;           // shift of the pressure on a foot that tips
    double grip = 0.45;                  // largest F_x / F_z and F_y / F_z
    TrunkRighting trunk;
    double turn_max_Nm = 40;
    double height_m = 0.55, height_N_per_m = 0, height_Ns_per_m = 0;
    double lift_N_per_m = 0, lift_max = 0.6;
    double arm_Nm_per_m = 0, arm_from_m = 0;
    double trust_per_s = 1000;  // rate at which xi follows what is measured
    double smooth_s = 0;        // time constant of the torques' low pass
  };

  // Throws std::invalid_argument for a passive joint or one without a role here, OptionError for a wrong foot.
  explicit Stance(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;

 private:
  void declare_pressure(Declaration& declaration);
  void declare_trunk(Declaration& declaration);
  void declare_signals(Declaration& declaration);
  struct Answer {
    double pressure_m = 0, beyond_m = 0, turn_Nm = 0;
  };
  Answer answer(double dcm_m, double rest_m, double pull, const std::array<double, 2>& sole_m,
                double righting_Nm) const noexcept;
  void look(const ControlInput& input) noexcept;
  void find_pressure(const BaseStatus& base) noexcept;
  void find_force() noexcept;
  void load(std::size_t side, double share) noexcept;

  Standing standing_;
  std::array<LegLoad, 2> legs_;
  double weight_N_;
  Config config_;
};

std::unique_ptr<ControlObject> make_stance(const ObjectSetup& setup);

}  // namespace kadans
