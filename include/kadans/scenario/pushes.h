// The pushes of a scenario, put on the model at their times.
#pragma once

#include <string>
#include <vector>

#include "kadans/config/scenario_push.h"
#include "kadans/plant/world.h"

namespace kadans {

class Pushes {
 public:
  // Throws InputError for a link that the robot does not have. `file`: where the pushes were read.
  Pushes(const std::vector<ScenarioPush>& pushes, const RobotModel& model, const std::string& file);

  // Before the step of the plant that begins at this time and lasts dt_s. The impulse of a push comes out right however
  // its times lie to the steps': each step gets the mean force over its time.
  void apply(World& world, double time_s, double dt_s) const;

 private:
  struct Push {
    ScenarioPush push;
    std::size_t link = 0;
  };
  std::vector<Push> pushes_;
};

}  // namespace kadans
