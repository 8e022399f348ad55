#include "disturbances.h"

#include <cmath>

namespace kadans {

Disturbances::Disturbances(const ScenarioConfig& scenario, const RobotModel& model)
    : pushes_(scenario.pushes, model, scenario.file) {
  for (const ScenarioFault& fault : scenario.faults) {
    if (fault.kind == ScenarioFault::Kind::behaviors_silent || fault.kind == ScenarioFault::Kind::clock_missed)
      faults_.push_back(fault);
  }
  happened_.resize(faults_.size());
}

void Disturbances::apply(Lockstep& lockstep, World& world) {
  const double time_s = 1e-9 * static_cast<double>(lockstep.time_ns());
  bool silent = false;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const ScenarioFault& fault = faults_[i];
    if (!(time_s >= fault.from_s && time_s < fault.until_s)) continue;
    if (fault.kind == ScenarioFault::Kind::behaviors_silent) {
      silent = true;
    } else if (std::isfinite(fault.until_s) || !happened_[i]) {  // without an end it happens once
      lockstep.miss(static_cast<std::uint32_t>(fault.size));
    }
    happened_[i] = true;
  }
  lockstep.silence_behaviors(silent);
  pushes_.apply(world, time_s, 1e-9 * static_cast<double>(lockstep.control_period_ns()));
}

}  // namespace kadans
