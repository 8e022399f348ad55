// The disturbances that a scenario applies to a run from outside: pushes on the robot, what a person carries elsewhere,
// missing behavior ticks, missed control ticks.
#pragma once

#include <string>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "engine/lockstep.h"
#include "kadans/plant/world.h"

namespace kadans {

// Applies the pushes of a scenario to the model at their times.
class Pushes {
 public:
  // Throws InputError for a link that the robot does not have. `file` is the file from which the pushes were read.
  Pushes(const std::vector<ScenarioPush>& pushes, const RobotModel& model, const std::string& file);

  // To be called before the step of the plant that begins at time_s and lasts dt_s. Each step gets the mean force over
  // its time, so the total impulse is right even when a push begins or ends within a step.
  void apply(WorldRobot& robot, double time_s, double dt_s) const;

 private:
  struct Push {
    ScenarioPush push;
    std::size_t link = 0;
  };
  std::vector<Push> pushes_;
};

// Carries a robot, and the objects of the world, where the scenario says. Those of the world are the first robot's.
class Hands {
 public:
  explicit Hands(const ScenarioConfig& scenario) : robot_(scenario.carried), objects_(scenario.world.carried) {}

  // To be called before the step that begins at time_ns and lasts dt_ns. Throws std::invalid_argument for what cannot
  // be carried.
  void apply(World& world, WorldRobot& robot, std::int64_t time_ns, std::int64_t dt_ns) const;

 private:
  std::vector<ScenarioCarry> robot_;
  std::vector<ObjectCarry> objects_;
};

class Disturbances {
 public:
  // Throws InputError for a link that the robot does not have.
  Disturbances(const ScenarioConfig& scenario, const RobotModel& model);

  // To be called before each step.
  void apply(Lockstep& lockstep, const BehaviorEngine& behaviors, World& world, WorldRobot& robot);

 private:
  Pushes pushes_;
  Hands hands_;
  std::vector<ScenarioFault> faults_;  // only those of behaviors and clock
  std::vector<bool> happened_;         // for each fault: it has begun
};

}  // namespace kadans
