// What a match is played in: a simulation on virtual time (here), or a world that is served in real time to robots in
// processes of their own (served_match.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "football/game_control.h"
#include "football/packet.h"
#include "football/plane.h"
#include "kadans/app/simulation.h"
#include "match_file.h"

namespace kadans::football {

class MatchWorld {
 public:
  virtual ~MatchWorld() = default;
  MatchWorld() = default;
  MatchWorld(const MatchWorld&) = delete;
  MatchWorld& operator=(const MatchWorld&) = delete;

  // One control period. False: nobody plays any more. Throws std::runtime_error when the model fails.
  virtual bool step() = 0;
  virtual std::int64_t time_ns() const = 0;    // at which the next step begins
  virtual std::int64_t period_ns() const = 0;  // of a step
  virtual std::uint64_t state_hash() const = 0;
  virtual std::vector<SaidLine> take_lines() = 0;

  virtual World& world() = 0;
  virtual std::size_t object(std::string_view name) const = 0;
  // Robots by number, in the order of MatchConfig::robots.
  virtual WorldRobot& robot(std::size_t number) = 0;
  virtual const Catalog& catalog(std::size_t number) const = 0;
  virtual bool active(std::size_t number) const = 0;     // its drives hold it, as far as can be known from outside
  virtual Pose2 odometry(std::size_t number) const = 0;  // along its path
  virtual void observe(std::size_t number, const Observation& observation) = 0;
  // What the simulated perception of a robot said since the last call, with the time of the picture.
  virtual std::vector<Observation> take_observed(std::size_t number) = 0;
  virtual std::uint64_t messages(std::size_t number) = 0;  // to its mates, so far

  // The referee's packet goes out to all robots; it comes back by packets().
  virtual void send(Bytes packet) = 0;
  // What came for the robots since the last call: whatever it is.
  virtual std::vector<std::vector<std::byte>> packets() = 0;
  // What a robot answers a game controller that is another program's.
  virtual void answer_referee(const RobotReturn& told) { (void)told; }
};

Pose2 ground_pose(const Pose& base) noexcept;  // of what stands on the ground

// On virtual time, bit for bit by its seed.
class SimulatedMatch : public MatchWorld {
 public:
  // Throws InputError: a team's files, a robot's.
  SimulatedMatch(const MatchConfig& match, std::uint64_t seed);

  bool step() override {
    simulation_.step();
    return true;
  }
  std::int64_t time_ns() const override { return simulation_.time_ns(); }
  std::int64_t period_ns() const override { return simulation_.period_ns(); }
  std::uint64_t state_hash() const override { return simulation_.state_hash(); }
  std::vector<SaidLine> take_lines() override { return simulation_.take_lines(); }
  World& world() override { return simulation_.world(); }
  std::size_t object(std::string_view name) const override { return simulation_.object(name); }
  WorldRobot& robot(std::size_t number) override { return simulation_.robot(number); }
  const Catalog& catalog(std::size_t number) const override { return simulation_.catalog(number); }
  bool active(std::size_t number) const override;
  Pose2 odometry(std::size_t number) const override;
  void observe(std::size_t number, const Observation& observation) override {
    simulation_.observe(number, observation);
  }
  std::vector<Observation> take_observed(std::size_t number) override { return simulation_.take_observed(number); }
  std::uint64_t messages(std::size_t number) override;
  void send(Bytes packet) override { packets_.emplace_back(packet.begin(), packet.end()); }
  std::vector<std::vector<std::byte>> packets() override { return std::exchange(packets_, {}); }
  Simulation& simulation() noexcept { return simulation_; }

 private:
  Simulation simulation_;
  std::vector<std::optional<SignalId>> sent_;  // the signal that counts its messages, where it has mates
  std::vector<std::vector<std::byte>> packets_;
};

}  // namespace kadans::football
