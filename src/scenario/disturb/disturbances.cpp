#include "disturbances.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace kadans {
namespace {

// The share of the impulse that has been given by this time.
double given_share(const ScenarioPush& push, double time_s) {
  const double share = std::clamp((time_s - push.at_s) / push.duration_s, 0.0, 1.0);
  return push.shape == ScenarioPush::Shape::constant ? share : 0.5 * (1 - std::cos(std::numbers::pi * share));
}

}  // namespace

Disturbances::Disturbances(const ScenarioConfig& scenario, const RobotModel& model)
    : pushes_(scenario.pushes, model, scenario.file), hands_(scenario) {
  for (const ScenarioFault& fault : scenario.faults) {
    if (fault.kind == ScenarioFault::Kind::behaviors_silent || fault.kind == ScenarioFault::Kind::clock_missed ||
        fault.kind == ScenarioFault::Kind::supervisor_silent)
      faults_.push_back(fault);
  }
  happened_.resize(faults_.size());
}

void Disturbances::apply(Lockstep& lockstep, const BehaviorEngine& behaviors, World& world, WorldRobot& robot) {
  const double time_s = 1e-9 * static_cast<double>(lockstep.time_ns());
  bool silent = false, undecided = false;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const ScenarioFault& fault = faults_[i];
    if (!(time_s >= fault.from_s && time_s < fault.until_s)) continue;
    if (fault.kind == ScenarioFault::Kind::behaviors_silent) {
      silent = true;
    } else if (fault.kind == ScenarioFault::Kind::supervisor_silent) {
      undecided = true;
    } else if (std::isfinite(fault.until_s) || !happened_[i]) {  // without an end it happens once
      lockstep.miss(static_cast<std::uint32_t>(fault.size));
    }
    happened_[i] = true;
  }
  if (!faults_.empty()) lockstep.silence(behaviors, {.behaviors = silent, .supervisor = undecided});
  hands_.apply(world, robot, lockstep.time_ns(), lockstep.control_period_ns());
  pushes_.apply(robot, time_s, 1e-9 * static_cast<double>(lockstep.control_period_ns()));
}

void Hands::apply(World& world, WorldRobot& robot, std::int64_t time_ns, std::int64_t dt_ns) const {
  const auto now = [&](double at_s) {
    const std::int64_t at_ns = std::llround(1e9 * at_s);
    return at_ns >= time_ns && at_ns < time_ns + dt_ns;
  };
  for (const ScenarioCarry& carry : robot_) {
    if (now(carry.at_s)) robot.carry(carry.to_m[0], carry.to_m[1], carry.heading_rad);
  }
  for (const ObjectCarry& carry : objects_) {
    if (now(carry.at_s)) world.put(carry.object, carry.to_m);
  }
}

Pushes::Pushes(const std::vector<ScenarioPush>& pushes, const RobotModel& model, const std::string& file) {
  Problems problems(file);
  for (const ScenarioPush& push : pushes) {
    if (const auto link = model.find_link(push.link.name)) {
      pushes_.push_back({push, *link});
    } else {
      problems.add_unknown(push.link.place, "link", push.link.name, model.link_names());
    }
  }
  problems.throw_if_any();
}

void Pushes::apply(WorldRobot& robot, double time_s, double dt_s) const {
  for (const auto& [push, link] : pushes_) {
    const double share = given_share(push, time_s + dt_s) - given_share(push, time_s);
    if (share <= 0) continue;
    Vec3 force_N{};
    for (std::size_t i = 0; i < 3; ++i) force_N[i] = push.impulse_Ns[i] * share / dt_s;
    robot.push(link, force_N, push.point_m);
  }
}

}  // namespace kadans
