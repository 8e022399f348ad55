// The disturbances that a scenario applies to a run from outside: pushes on the robot, missing behavior ticks, missed
// control ticks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "engine/lockstep.h"
#include "pushes.h"

namespace kadans {

class Disturbances {
 public:
  // Throws InputError for a link that the robot does not have.
  Disturbances(const ScenarioConfig& scenario, const RobotModel& model);

  // To be called before each step.
  void apply(Lockstep& lockstep, World& world);

 private:
  Pushes pushes_;
  std::vector<ScenarioFault> faults_;  // only those of behaviors and clock
  std::vector<bool> happened_;         // for each fault: it has begun
};

}  // namespace kadans
