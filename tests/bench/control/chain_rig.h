// The control engine on a chain of joints (chain_robot.h): a PID with gains on each, an ideal plant, all that a tick
// needs. Step the plant after each tick: otherwise its sensors count as silent, and what is measured is a robot that
// safety has switched off.
#pragma once

#include <memory>
#include <stdexcept>

#include "chain_robot.h"
#include "engine/lockstep.h"
#include "kadans/plant/ideal_world.h"

namespace kadans::bench {

inline std::unique_ptr<ControlSystem> with_gains(std::unique_ptr<ControlSystem> system) {
  ParameterTable& parameters = system->catalog.parameters;
  for (const std::string& name : parameters.names()) {
    const ParameterId id = parameters.find(name).value();
    if (name.ends_with("kp_Nm_per_rad")) (void)parameters.set(id, 40);
    if (name.ends_with("kd_Nms_per_rad")) (void)parameters.set(id, 4);
  }
  return system;
}

// Throws when safety has stepped in: then not the usual tick was measured.
inline void expect_normal(const ControlEngine& control) {
  if (control.state().status.safety.level != SafetyLevel::normal)
    throw std::runtime_error("the robot of a benchmark is not at its normal level");
}

struct ChainRig {
  ChainRig(std::size_t joints, const ControlObjectTypes& types) : robot(chain_robot(joints, types, "joint_pid")) {}

  Robot robot;
  std::unique_ptr<ControlSystem> system = with_gains(make_control_system(robot));
  Catalog& catalog = system->catalog;
  IdealWorld plant{robot.config.model, robot.config.plant};
  ControlSets sets{catalog, std::move(system->objects)};
  Estimator estimator{robot.config.model, robot.config.estimate, robot.config.engine.control_period_s};
  Safety safety{robot.config.safety, robot.config.model};
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control{robot.config.engine, plant, estimator, safety, sets, catalog, *exchange};
  BehaviorEngine behaviors{sets, *exchange, nullptr};
};

}  // namespace kadans::bench
