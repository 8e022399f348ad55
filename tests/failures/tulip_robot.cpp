#include "tulip_robot.h"

#include <algorithm>
#include <cmath>

namespace kadans::failures {
namespace {

SafetySettings with(SafetySettings settings, const Reactions& reactions) {
  settings.reactions = reactions;
  return settings;
}

}  // namespace

TulipParts::TulipParts(std::uint64_t seed)
    : robot(read_robot(KADANS_SOURCE_DIR "/config/tulip/robot.json")),
      sound(robot.config.model, robot.config.plant, seed),
      system(make_control_system(robot)) {}

TulipRobot::TulipRobot(std::uint64_t seed, const Reactions& reactions)
    : TulipParts(seed),
      Rig({.model = robot.config.model,
           .plant = sound,
           .catalog = system->catalog,
           .objects = std::move(system->objects),
           .engine = robot.config.engine,
           .estimate = robot.config.estimate,
           .safety = with(robot.config.safety, reactions),
           .seed = seed}) {}

double TulipRobot::torque_share() const {
  double share = 0;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    if (limits().joints[i].effort_max_Nm <= 0) continue;
    share = std::max(share, std::abs(plant.motor_Nm(i)) / limits().joints[i].effort_max_Nm);
  }
  return share;
}

}  // namespace kadans::failures
