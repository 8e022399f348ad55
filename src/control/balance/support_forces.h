// Keeps a robot standing on three feet or more by the forces of its legs on the ground, in effort mode: type
// "support_forces". Meant to be composed onto a posture ("sum").
//
// xi is the divergent component of motion (dcm_measure.h), c the centre of mass from the middle between the feet, p the
// centre of pressure, m g the weight, h the height of c.
//
// clang-format off
//   pressure  p = rest + pull (xi - rest), kept within the feet: it is where a force would have to act that turns nothing
//   force     F_x = m g (c_x - p_x) / h, and y alike, within grip F_z; F_z = m g and what brings c to its height
//   moment    about c: what rights the trunk in roll and pitch and damps its turning
//   feet      the least squares of forces that together make both (Focchi et al. 2017, Autonomous Robots 41, without its
//             inequalities). A foot that would have to pull bears nothing, and the others are asked anew; each keeps to its
//             cone of friction
//   torques   each leg bears its foot's force and its own weight (stance.h, LegLoad)
// clang-format on
//
// All feet are assumed to stand, on points. What they cannot do together is left to the posture.
//
// Joints      of the legs, those that shall bear.
// Options     feet: the links that stand, separated by blanks; required.
// Parameters  Config; <foot>.x_m, y_m, z_m: where it touches the ground, in the link's frame. `share` fades all torques
// in
//             and out; a change by 1 takes 0.2 s.
// Signals     State; <foot>.force_z_N; <joint>.effort_Nm.
// Start       the torques rise from 0 in 0.2 s.
// Not finite  no torque at all: the posture goes on alone.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "balance_joint.h"
#include "dcm_measure.h"
#include "kadans/control/control_object.h"
#include "stance.h"
#include "trunk_righting.h"

namespace kadans {

// The forces at points from c that together come nearest to a force and a moment about c: none pulls, each stays within
// its cone of friction. Forces as small as can be. Does not allocate.
//
// Control thread.
void distribute(std::span<const Vec3> points_m, const Vec3& force_N, const Vec3& moment_Nm, double grip,
                std::span<Vec3> forces_N) noexcept;

struct SupportForcesState {
  double dcm_x_m = 0, dcm_y_m = 0;
  double cop_x_m = 0, cop_y_m = 0;  // p
  Vec3 force_N{}, moment_Nm{};
  double share = 0;
};

class SupportForces final : public Balancing<SupportForcesState> {
 public:
  static constexpr std::size_t least_feet = 3;

  struct Config {
    double share = 0;                       // 0..1
    double offset_x_m = 0, offset_y_m = 0;  // rest: where xi shall be, from the middle between the feet
    double pull = 1.5;
    TrunkRighting trunk;
    double turn_Nms_per_rad = 0;
    double height_m = 0, height_N_per_m = 0, height_Ns_per_m = 0;
    double lift_max = 0.5;  // of the weight
    double grip = 0.45;
    double smooth_s = 0;  // time constant of the torques' low pass
  };

  // Throws std::invalid_argument for a passive joint or one on which no foot hangs, OptionError for wrong feet.
  explicit SupportForces(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;

 private:
  struct Foot {
    std::size_t link = 0;
    std::string name;
    LegLoad load;
    Vec3 at_m{};     // in the link's frame
    Vec3 point_m{};  // from the base's origin
    Vec3 force_N{};
  };
  void declare_signals(Declaration& declaration);
  bool measure(const ControlInput& input) noexcept;
  void find_force(const BaseStatus& base) noexcept;
  void load_legs() noexcept;

  MovingBody body_;
  std::vector<Foot> feet_;
  double weight_N_;
  Vec3 com_m_{}, velocity_m_s_{};  // from the feet's middle
  std::array<Vec3, max_feet> points_m_{}, forces_N_{};
  Config config_;
};

std::unique_ptr<ControlObject> make_support_forces(const ObjectSetup& setup);

}  // namespace kadans
