// Bears the robot on one leg and holds its trunk upright, in effort mode: type "stance_leg". It is for the part of a
// step in which this leg stands, and is composed ("sum") onto an object that holds the leg's joints in position.
//
// c is the centre of mass over the foot's frame, p the centre of pressure, m g the weight. The hip of the leg that
// stands rights the trunk by the attitude that is measured (SIMBICON, Yin et al. 2007, ACM Trans. Graph. 26(3)). A
// moment of the hip alone would push the foot along the ground. So the moment L is one with the force of the ground on
// the foot:
//
// clang-format off
//   moment   L rights the trunk in roll and pitch
//   force    F_z = m g, F_x = (F_z (c_x - p_x) - L_y) / c_z, F_y = (F_z c_y + L_x) / c_z, both within grip F_z
//   torques  The leg bears F and its own weight (LegLoad, stance.h). The joint that holds its angle bears the rest.
// clang-format on
//
// With L = 0 the force goes through the centre of mass, and the robot falls over the foot as an inverted pendulum.
//
// Joints      of the leg, those that shall bear.
// Option      foot: the link that stands; required.
// Parameters  Config.
// Signals     State, and <joint>.effort_Nm.
// Start       the torques rise from 0 in rise_s.
// Not finite  no torque at all: the position loops go on alone.
#pragma once

#include <memory>
#include <vector>

#include "control/balance/balance_joint.h"
#include "control/balance/dcm_measure.h"
#include "control/balance/stance.h"
#include "control/balance/trunk_righting.h"
#include "kadans/control/control_object.h"
#include "kadans/model/kinematics.h"

namespace kadans {

struct StanceLegState {
  Vec3 com_m{};  // c
  double turn_x_Nm = 0, turn_y_Nm = 0;
  Vec3 force_N{};
  double share = 0;
};

class StanceLeg final : public Balancing<StanceLegState> {
 public:
  struct Config {
    double rise_s = 0.03;
    double pressure_x_m = 0;  // p, forward of the foot's frame
    TrunkRighting trunk;
    double grip = 0.45;
    double sole_m = 0.06;  // how far the sole is below the foot's frame
  };

  // Throws std::invalid_argument for a passive joint or one that is not of the leg, OptionError for a wrong foot.
  explicit StanceLeg(const ObjectSetup& setup);

  void declare(Declaration& declaration) override;
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override;

 private:
  void declare_signals(Declaration& declaration);
  // False when the robot does not stand on the foot, or a measurement is not finite.
  bool measure(const ControlInput& input) noexcept;
  void load(const BaseStatus& base) noexcept;

  std::size_t foot_;       // link
  Kinematics kinematics_;  // the base's origin at 0
  LegLoad leg_;
  double weight_N_;
  Config config_;
};

std::unique_ptr<ControlObject> make_stance_leg(const ObjectSetup& setup);

}  // namespace kadans
