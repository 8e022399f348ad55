#include "served_world.h"

#include <algorithm>
#include <stdexcept>

#include "kadans/plant/plant_type.h"

namespace kadans {

ServedWorld::ServedWorld(const Robot& robot, const std::string& type, std::uint64_t seed) {
  const PlantType& served = plant_type_named(robot.config, "--plant", {type, {}}, &PlantType::is_model);
  try {
    model_ = served.make_world({robot.config.model, robot.config.plant, seed});
  } catch (const std::invalid_argument& error) {
    refuse(robot.config.file, error.what());
  }
  world_ = model_.get();
  robots_.push_back(&world_->robot(0));
  sites_.push_back({"", robot.config});
}

ServedWorld::ServedWorld(const ScenarioConfig& scenario, std::uint64_t seed)
    : assembly_(std::make_unique<Assembly>(scenario, seed, log_)), world_(assembly_->world()) {
  const RunParts parts = assembly_->parts();
  const auto add = [&](const RunParts& robot, const Assembly& assembled, const ScenarioConfig& settings) {
    robots_.push_back(&robot.robot);
    perception_.push_back(robot.perception);
    sites_.push_back({robot.name, assembled.robot(), &assembled.catalog()});
    pushes_.emplace_back(settings.pushes, robot.model, scenario.file);
    hands_.emplace_back(settings);
  };
  add(parts, *assembly_, scenario);
  for (std::size_t i = 0; i < parts.others.size(); ++i)
    add(parts.others[i], *assembly_->others()[i], scenario.robots[i]);
}

std::size_t ServedWorld::object(std::string_view name) const { return assembly_->object(name); }

void ServedWorld::step(std::int64_t dt_ns) {
  const double time_s = 1e-9 * static_cast<double>(time_ns_), dt_s = 1e-9 * static_cast<double>(dt_ns);
  for (std::size_t i = 0; i < pushes_.size(); ++i) {
    hands_[i].apply(*world_, *robots_[i], time_ns_, dt_ns);
    pushes_[i].apply(*robots_[i], time_s, dt_s);
  }
  world_->step(dt_ns);
  time_ns_ += dt_ns;
}

}  // namespace kadans
