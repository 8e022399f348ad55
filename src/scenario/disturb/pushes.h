// Applies the pushes of a scenario to the model at their times.
#pragma once

#include <string>
#include <vector>

#include "config/scenario/scenario_push.h"
#include "kadans/plant/world.h"

namespace kadans {

class Pushes {
 public:
  // Throws InputError for a link that the robot does not have. `file` is the file from which the pushes were read.
  Pushes(const std::vector<ScenarioPush>& pushes, const RobotModel& model, const std::string& file);

  // To be called before the step of the plant that begins at time_s and lasts dt_s. Each step gets the mean force over
  // its time, so the total impulse is right even when a push begins or ends within a step.
  void apply(World& world, double time_s, double dt_s) const;

 private:
  struct Push {
    ScenarioPush push;
    std::size_t link = 0;
  };
  std::vector<Push> pushes_;
};

}  // namespace kadans
