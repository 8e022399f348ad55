// Keeps a robot up on both its feet by the forces of its legs on the ground, in effort mode: type "stance". Meant to be
// composed onto a soft posture ("sum").
//
// From where the robot is going to what each joint has to give, in four steps:
//
//   pressure  d xi / dt = w0 (xi - p - L / (m g)), xi being the divergent component of motion (standing.h), p the
//   centre
//             of pressure, L the moment that turns the robot about its centre of mass: both do the same to xi, so that
//             p + L / (m g) = rest + pull (xi - rest). p has to lie within the soles. Its y shares the weight among the
//             feet; between two feet side by side the soles reach as far forward as one does, and a foot set ahead
//             lengthens that in the direction of that foot alone.
//   turn      L rights the trunk as far as the soles make up for it: so that rest + need (xi - rest) can still be had.
//             Where they do not reach it bows the trunk the way the robot falls, which pushes the hips back, and rights
//             it later (Horak and Nashner 1986, J. Neurophysiology 55(6)). The arms swing with what is wanted beyond.
//   forces    F_x = (F_z (c_x - p_x) - L_y) / c_z, F_y = (F_z (c_y - p_y) + L_x) / c_z: through p, with the moment L;
//   no
//             more along the ground than it holds. F_z is the weight, and what lifts the robot to its height; the
//             further p is from the centre of mass, the harder the legs press: a heavier robot has longer soles.
//   torques   each leg bears its share of that force where its foot is pressed, and its own weight: leg_load.h. On a
//             foot that tips the pressure goes back from its edge.
//
// A foot whose ankle gives no more than its load can hold stays flat. A posture that holds the hips or ankles stiffly
// beside this takes what the trunk and the soles would do: its gains have to be small there. A sole that is pressed to
// its edge without any delay chatters on the ground: smooth_s is for that.
//
// Joints      of each side, what of the legs' joints shall bear, and *_shoulder_pitch.
// Options     left_foot, right_foot: the links that stand; required.
// Parameters  Config. `share` fades the whole in and out, 1 takes 0.2 s.
// Signals     State, and <joint>.effort_Nm.
// Start       from no torque, in 0.2 s.
// Not finite  no torque at all: the posture goes on alone.
#pragma once

#include <memory>
#include <vector>

#include "kadans/control/control_object.h"
#include "kadans/control/joint_axis.h"
#include "kadans/control/leg_load.h"
#include "kadans/control/standing.h"

namespace kadans {

class Stance final : public ControlObject {
 public:
  struct Config {
    double share = 0;                       // 0..1
    double offset_x_m = 0, offset_y_m = 0;  // rest: where xi shall be, from the middle between the feet's frames
    double pull_x = 2, pull_y = 2;
    double need = 1.1;
    double toe_m = 0.12, heel_m = 0.07;  // from a foot's frame to where its pressure may go
    double side_m = 0;                   // how far out of the feet's frames p_y may go
    double sole_m = 0.06;                // below a foot's frame
    double flat_m_per_rad = 0;
    double grip = 0.45;    // most of F_x / F_z
    double pitch_rad = 0;  // of the trunk
    double upright_Nm_per_rad = 0, upright_Nms_per_rad = 0;
    double level_Nm_per_rad = 0, level_Nms_per_rad = 0;
    double turn_max_Nm = 40;
    double height_m = 0.55, height_N_per_m = 0, height_Ns_per_m = 0;
    double lift_N_per_m = 0, lift_max = 0.6;
    double arm_Nm_per_m = 0, arm_from_m = 0;
    double smooth_s = 0;  // of the torques' low pass
  };
  struct State {
    double dcm_x_m = 0, dcm_y_m = 0;
    double cop_x_m = 0, cop_y_m = 0;      // p
    double beyond_x_m = 0;                // what of it is wanted beyond the soles even so
    double turn_x_Nm = 0, turn_y_Nm = 0;  // L
    double left = 0;                      // share of the weight on the left foot
    Vec3 force_N{};
    double share = 0;
  };

  // Throws std::invalid_argument for a passive joint or one of no known role, OptionError for feet.
  explicit Stance(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void start(const ControlInput& input) noexcept override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;
  void set_point(std::uint32_t, double, double) noexcept override {}  // has none
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }
  const State& state() const noexcept { return state_; }

 private:
  struct Part {
    JointAxis axis;
    bool arm = false;
    double wanted_Nm = 0, effort_Nm = 0;
  };
  void declare_pressure(Declaration& declaration);
  void declare_trunk(Declaration& declaration);
  void declare_signals(Declaration& declaration);
  struct Answer {
    double pressure_m = 0, beyond_m = 0, turn_Nm = 0;
  };
  Answer answer(double dcm_m, double rest_m, double pull, const std::array<double, 2>& sole_m,
                double righting_Nm) const noexcept;
  // About x and y: what the trunk would have, were the soles long enough.
  std::array<double, 2> righting_Nm(const BaseStatus& base) const noexcept;
  void find_pressure(const BaseStatus& base) noexcept;
  void find_force() noexcept;
  void load(std::size_t side, double share) noexcept;

  std::vector<Part> parts_;
  Standing standing_;
  std::array<LegLoad, 2> legs_;
  double weight_N_;
  Config config_;
  State state_;
};

std::unique_ptr<ControlObject> make_stance(const ObjectSetup& setup);

}  // namespace kadans
