// What a scenario does to a run from outside, in every step at its time: pushes on the robot, behavior ticks that do
// not come, control ticks that are missed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kadans/config/scenario_config.h"
#include "kadans/engine/lockstep.h"
#include "kadans/scenario/pushes.h"

namespace kadans {

class Disturbances {
 public:
  // Throws InputError for names that the robot does not have.
  Disturbances(const ScenarioConfig& scenario, const RobotModel& model);

  // Before each step.
  void apply(Lockstep& lockstep, World& world);

 private:
  Pushes pushes_;
  std::vector<ScenarioFault> faults_;  // of behaviors and clock
  std::vector<bool> happened_;         // of each fault
};

}  // namespace kadans
