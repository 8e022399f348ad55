// How a law in effort mode that rests on a model of the robot takes over a joint. The torque that was there continues;
// what the law does not explain of it is an offset. The offset stands while the model's data are still those of before,
// and fades away once the high level has seen the robot since: that changes the law at once, so the offset is then
// found anew. An integral, where there is one, may take the offset over instead and keep it.
#pragma once

#include <algorithm>
#include <cmath>

#include "kadans/control/handover.h"

namespace kadans {

class EffortTakeover {
 public:
  void start(double effort_Nm) noexcept {
    effort_Nm_ = std::isfinite(effort_Nm) ? effort_Nm : 0;
    pending_ = true;
    known_ = false;
  }

  // What to add to the law's torque, beside the integral, which takes what it can within +-integral_max_Nm when the
  // offset is found. `known`: the model's data are of this activation.
  double step(double law_Nm, bool known, double dt_s, double& integral_Nm, double integral_max_Nm) noexcept {
    if (pending_ || known != known_) {
      double rest_Nm = effort_Nm_ - law_Nm;
      if (!std::isfinite(rest_Nm)) rest_Nm = 0;
      integral_Nm = std::clamp(rest_Nm, -integral_max_Nm, integral_max_Nm);
      offset_.start(rest_Nm - integral_Nm);
      pending_ = false;
      known_ = known;
      dt_s = 0;
    }
    return offset_.step(known ? dt_s : 0);
  }
  // The torque that came out in the end, from which the next finding of the offset continues.
  void leave(double effort_Nm) noexcept { effort_Nm_ = effort_Nm; }

 private:
  FadingEffort offset_;
  double effort_Nm_ = 0;
  bool pending_ = true, known_ = false;
};

}  // namespace kadans
