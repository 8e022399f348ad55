#include "dcm_balance.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace kadans {
namespace {

double beyond(double error, double back, double front) noexcept { return error - std::clamp(error, -back, front); }

}  // namespace

DcmBalance::DcmBalance(const ObjectSetup& setup)
    : standing_(setup), weight_N_(gravity_of_balance_m_s2 * setup.model.mass_kg()) {
  const std::vector<JointPart> parts = leg_parts(setup.model, standing_.feet());
  for (JointAxis& axis : joint_axes(setup)) {
    const JointPart& part = parts[axis.joint];
    if (part.part != LegPart::ankle_pitch && part.part != LegPart::hip_pitch && part.part != LegPart::hip_roll &&
        part.part != LegPart::swing)
      throw std::invalid_argument("joint " + axis.name +
                                  " has no part in balance: in a leg it is neither the first nor the last that turns "
                                  "about y, nor the first about x; and it is no shoulder that turns about y");
    parts_.push_back({.axis = std::move(axis), .in_leg = part});
  }
}

void DcmBalance::declare(Declaration& d) {
  Config& c = config_;
  d.tunable("share", "", 0, 1, c.share, "Share of all its torques.");
  d.tunable("offset_x_m", "m", -0.2, 0.2, c.offset_x_m,
            "Where the divergent component shall be, forward of the ankles.");
  d.tunable("ankle_per_m", "", 0, 10, c.ankle_per_m, "Shift of the centre of pressure per error.");
  d.tunable("ankle_max_Nm", "Nm", 0, 50, c.ankle_max_Nm, "Bound of an ankle's torque.");
  d.tunable("smooth_s", "s", 0, 0.1, c.smooth_s, "Time constant of the torques' low pass; 0: none.");
  d.tunable("reach_front_m", "m", 0, 0.5, c.reach_front_m, "Error forward that the ankles hold.");
  d.tunable("reach_back_m", "m", 0, 0.5, c.reach_back_m, "Error backward that the ankles hold.");
  d.tunable("reach_side_m", "m", 0, 0.5, c.reach_side_m, "Error to the side that the posture holds.");
  d.tunable("hip_Nm_per_m", "Nm/m", -5000, 5000, c.hip_Nm_per_m, "Torque of a hip per error beyond reach.");
  d.tunable("arm_Nm_per_m", "Nm/m", -5000, 5000, c.arm_Nm_per_m, "Torque of a shoulder per error beyond reach.");
  d.tunable("roll_Nm_per_m", "Nm/m", -5000, 5000, c.roll_Nm_per_m, "Torque of a hip roll per error to the side.");
  const State& s = state_;
  d.signal({"com_x_m", "m", "Centre of mass, forward of the feet's middle."}, &s.com_x_m);
  d.signal({"com_y_m", "m", "Centre of mass, left of the feet's middle."}, &s.com_y_m);
  d.signal({"com_z_m", "m", "Centre of mass, over the feet's frames."}, &s.com_z_m);
  d.signal({"dcm_x_m", "m", "Divergent component of motion, forward of the feet's middle."}, &s.dcm_x_m);
  d.signal({"dcm_y_m", "m", "Divergent component of motion, left of the feet's middle."}, &s.dcm_y_m);
  d.signal({"beyond_x_m", "m", "What of the error forward is beyond reach."}, &s.beyond_x_m);
  d.signal({"beyond_y_m", "m", "What of the error to the side is beyond reach."}, &s.beyond_y_m);
  d.signal({"share", "", "Share of its torques that acts."}, &s.share);
  declare_efforts(d);
}

// False when it does not stand, or something is not measured.
bool DcmBalance::measure(const ControlInput& input) noexcept {
  const bool stands = standing_.update(input);
  const Vec3& com = standing_.com_m();
  State& s = state_;
  s.com_x_m = com[0];
  s.com_y_m = com[1];
  s.com_z_m = com[2];
  s.dcm_x_m = standing_.dcm_x_m();
  s.dcm_y_m = standing_.dcm_y_m();
  s.beyond_x_m = beyond(s.dcm_x_m - config_.offset_x_m, config_.reach_back_m, config_.reach_front_m);
  s.beyond_y_m = beyond(s.dcm_y_m, config_.reach_side_m, config_.reach_side_m);
  return stands;
}

double DcmBalance::law_Nm(LegPart part) const noexcept {
  const Config& c = config_;
  const State& s = state_;
  switch (part) {
    case LegPart::ankle_pitch: {
      const double wanted_Nm = weight_N_ * c.ankle_per_m * (s.dcm_x_m - c.offset_x_m) / 2;
      return std::clamp(wanted_Nm, -c.ankle_max_Nm, c.ankle_max_Nm);
    }
    case LegPart::hip_pitch:
      return -c.hip_Nm_per_m * s.beyond_x_m;
    case LegPart::swing:
      return c.arm_Nm_per_m * s.beyond_x_m;
    case LegPart::hip_roll:
      return c.roll_Nm_per_m * s.beyond_y_m;
    default:
      return 0;
  }
}

void DcmBalance::step(const ControlInput& input, ActuationFrame& actuation) noexcept {
  const bool stands = measure(input);
  state_.share = faded_share(state_.share, config_.share, stands, input.dt_s);
  for (BalanceJoint& part : parts_) {
    part.wanted_Nm = part.in_leg.sign * law_Nm(part.in_leg.part);
    part.give(state_.share, stands, 1, config_.smooth_s, input.dt_s, actuation);
  }
}

std::unique_ptr<ControlObject> make_dcm_balance(const ObjectSetup& setup) {
  return std::make_unique<DcmBalance>(setup);
}

}  // namespace kadans
