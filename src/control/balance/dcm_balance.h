// Keeps a standing robot's balance, in effort mode: type "dcm_balance". Meant to be composed onto a posture ("sum").
//
// xi is the divergent component of motion (dcm_measure.h). Forward and backward the robot is balanced as people do it
// (Horak and Nashner 1986, J. Neurophysiology 55(6)): hips and arms take what the ankles cannot hold.
//
//   ankles  tau = m g k_ankle e / 2 each, e = xi_x - offset_x; at most ankle_max, what the sole's length gives
//   hips    tau = -k_hip r_x each, r_x the part of e beyond reach_front or reach_back: the torso bows towards the fall
//   arms    tau = k_arm r_x each: they swing the same way
//   roll    tau = k_roll r_y on both hip rolls, r_y the part of xi_y beyond reach_side: the load goes to the foot on
//           the side of the fall
//
// A foot that is pressed to its edge by torques without any delay chatters on the ground; smooth_s prevents that.
//
// Joints      of each leg the pitch of ankle and hip and the roll of the hip, and shoulders that turn about y, all or
//             some: leg_parts.h says which are which.
// Options     left_foot, right_foot: the links that stand; required.
// Parameters  Config. `share` fades all torques in and out; a change by 1 takes 0.2 s.
// Signals     State, and <joint>.effort_Nm.
// Start       the torques rise from 0 in 0.2 s.
// Not finite  no torque at all: the posture goes on alone.
#pragma once

#include <memory>
#include <vector>

#include "balance_joint.h"
#include "dcm_measure.h"
#include "kadans/control/control_object.h"
#include "leg_parts.h"

namespace kadans {

struct DcmBalanceState {
  double com_x_m = 0, com_y_m = 0, com_z_m = 0;
  double dcm_x_m = 0, dcm_y_m = 0;
  double beyond_x_m = 0, beyond_y_m = 0;  // r_x, r_y
  double share = 0;
};

class DcmBalance final : public Balancing<DcmBalanceState> {
 public:
  struct Config {
    double share = 1;            // 0..1
    double offset_x_m = 0.02;    // where xi shall be, forward of the ankles
    double ankle_per_m = 1;      // shift of the centre of pressure per error
    double ankle_max_Nm = 12;    // each
    double smooth_s = 0;         // time constant of the torques' low pass
    double reach_front_m = 0.1;  // error that the ankles can hold
    double reach_back_m = 0.06;
    double hip_Nm_per_m = 0;
    double arm_Nm_per_m = 0;
    double roll_Nm_per_m = 0;
    double reach_side_m = 0;
  };

  // Throws std::invalid_argument for a passive joint or one without a role here, OptionError for a wrong foot.
  explicit DcmBalance(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;

 private:
  bool measure(const ControlInput& input) noexcept;
  double law_Nm(LegPart part) const noexcept;

  Standing standing_;
  double weight_N_;
  Config config_;
};

std::unique_ptr<ControlObject> make_dcm_balance(const ObjectSetup& setup);

}  // namespace kadans
