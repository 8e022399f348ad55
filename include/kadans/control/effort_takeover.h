// How a law in effort mode that uses a model of the robot takes over a joint. The torque from before continues: its
// difference to the law's torque becomes an offset. The offset is constant while the model's data are older than this
// activation. The first data of this activation change the law's torque at once, so the offset is then computed anew
// and fades away. If the law has an integral, it takes over what the model does not explain, and keeps it. What answers
// the present error is no part of that: an integral that took it would cancel the feedback until it is unwound.
#pragma once

#include <algorithm>
#include <cmath>

#include "kadans/control/takeover.h"

namespace kadans {

class EffortTakeover {
 public:
  void start(double effort_Nm) noexcept {
    effort_Nm_ = std::isfinite(effort_Nm) ? effort_Nm : 0;
    pending_ = true;
    known_ = false;
  }

  // start() was called and no step since.
  bool pending() const noexcept { return pending_; }

  // The next step() computes the offset.
  bool due(bool known) const noexcept { return pending_ || known != known_; }
  // Returns what to add to the sum of the law's torque and the integral. When the offset is computed, the integral
  // takes what it can of the torque beyond `model_Nm`, the law's torque without its feedback, within +-integral_max_Nm.
  // `known`: the model's data are of this activation.
  double step(double law_Nm, double model_Nm, bool known, double dt_s, double& integral_Nm,
              double integral_max_Nm) noexcept {
    if (due(known)) {
      double rest_Nm = effort_Nm_ - law_Nm;
      if (!std::isfinite(rest_Nm)) rest_Nm = 0;
      const double unexplained_Nm = std::isfinite(model_Nm) ? effort_Nm_ - model_Nm : 0;
      integral_Nm = std::clamp(unexplained_Nm, -integral_max_Nm, integral_max_Nm);
      offset_.start(rest_Nm - integral_Nm);
      pending_ = false;
      known_ = known;
      dt_s = 0;
    }
    return offset_.step(known ? dt_s : 0);
  }
  // The same without an integral.
  double step(double law_Nm, bool known, double dt_s) noexcept {
    double none_Nm = 0;
    return step(law_Nm, law_Nm, known, dt_s, none_Nm, 0);
  }
  // Takes the final torque of this step, from which the offset is computed the next time.
  void leave(double effort_Nm) noexcept { effort_Nm_ = effort_Nm; }
  void pass_state(auto& bytes) noexcept { bytes(offset_, effort_Nm_, pending_, known_); }

 private:
  FadingEffort offset_;
  double effort_Nm_ = 0;
  bool pending_ = true, known_ = false;
};

}  // namespace kadans
