// Cuts what is asked of two coupled joints to what their two drives have. A pair of joint torques, each within its
// joint's limit, may ask more of one drive than it can give.
//
// The torques of both joints are scaled by the same factor, so that their ratio stays, and with it that neither joint
// is driven where its own limits forbid it. Beyond a drive's speed its torque in that direction fades out, as a joint's
// does. In modes in which the drive makes the torque, the speeds asked are scaled in the same way.
//
// One owner, the control thread; nothing here allocates or throws after the construction.
#pragma once

#include "kadans/model/transmission.h"
#include "ladder.h"
#include "settings.h"

namespace kadans {

class CouplingLimiter {
 public:
  CouplingLimiter(const SafetySettings& settings, const Transmission& transmission);

  // Cuts the frame's two actuations in place. Returns the fault of the drive that cut most, or none.
  FaultMask limit(const JointStates& joints, ActuationFrame& actuation) noexcept;
  // Value, limit and the drive's name of the fault that limit() has just found.
  void describe(Fault& fault) const noexcept;
  std::size_t joint(std::size_t drive) const noexcept { return transmission_.joints()[drive]; }
  std::size_t cutting_joint() const noexcept { return joint(cut_.drive); }  // in whose place the drive stands

 private:
  struct Cut {
    double share = 1;  // of what was asked
    FaultCode code = FaultCode::none;
    std::size_t drive = 0;
    double value = 0, limit = 0;
  };
  void consider(const Cut& cut) noexcept {
    if (cut.share < cut_.share) cut_ = cut;
  }

  Transmission transmission_;
  std::array<double, 2> effort_max_Nm_, velocity_max_rad_s_;  // infinite: not limited
  double velocity_margin_;
  std::array<FaultWords, 2> names_;
  Cut cut_;
};

}  // namespace kadans
