// What `kadans plant` serves: the model of one robot, or the world of a scenario with all its robots, what the scenario
// sets and draws, its pushes, and the faults of its plants. Who drives a robot plays its behaviors.
//
// One thread at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/assembly/assembly.h"
#include "scenario/disturb/disturbances.h"

namespace kadans {

class ServedWorld final : public World {
 public:
  // The robots of its world, as their files describe them. They outlive the world.
  struct Site {
    std::string name;  // "": the only one
    const RobotConfig& robot;
    const Catalog* catalog = nullptr;  // of a scenario's
  };

  // Throws InputError.
  ServedWorld(const Robot& robot, const std::string& type, std::uint64_t seed);
  ServedWorld(const ScenarioConfig& scenario, std::uint64_t seed);

  const std::vector<Site>& sites() const noexcept { return sites_; }
  std::size_t robot_count() const noexcept override { return robots_.size(); }
  // The simulated perception of a scenario's robot, which who serves the world lets look.
  const std::vector<SimulatedPerception*>& perception(std::size_t number) const { return perception_.at(number); }
  WorldRobot& robot(std::size_t number) noexcept override { return *robots_[number]; }
  // The world's object with this name. Throws std::invalid_argument.
  std::size_t object(std::string_view name) const;
  void put(std::size_t object, const Vec3& position_m) override { world_->put(object, position_m); }
  void step(std::int64_t dt_ns) override;
  void hash(StateHash& hash) const noexcept override { world_->hash(hash); }

 private:
  std::unique_ptr<World> model_;  // of a robot alone
  RunLog log_;
  std::unique_ptr<Assembly> assembly_;  // of a scenario; its engines rest
  World* world_ = nullptr;
  std::vector<WorldRobot*> robots_;
  std::vector<Site> sites_;
  std::vector<std::vector<SimulatedPerception*>> perception_;
  std::vector<Pushes> pushes_;  // a robot each; none of a robot alone
  std::vector<Hands> hands_;
  std::int64_t time_ns_ = 0;
};

}  // namespace kadans
