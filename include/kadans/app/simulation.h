// A scenario of one robot or several, stepped by a program of one's own: what `kadans sim` steps, on virtual time and
// bit for bit by its seed, with what a game's referee needs beside it. It reads the truth, moves what a person's hands
// would move, and says what the robots perceive. Between two steps everything may be looked at and changed.
//
// One thread. Physics of several robots, each with its engines, behaviors and supervisor: docs/scenarios.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/control/catalog.h"
#include "kadans/plant/world.h"
#include "kadans/signal/observation.h"
#include "kadans/signal/status.h"

namespace kadans {

// What a behavior, decisions or a part of the runtime said.
struct SaidLine {
  enum class Kind : std::uint8_t { transition, info, warning, error };
  std::int64_t time_ns = 0;
  Kind kind = Kind::info;
  std::string who, text;  // of a further robot: "NAME.greet_ball"
};

// The record of a simulation, and what it holds.
struct SimulationRecord {
  std::filesystem::path file;
  std::string signals{};  // "base.*, seen.*@10": those alone (docs/viewing.md); "": the choice of the robot's file
  std::string repeat{};   // the command that makes the same run again, for people
};

// Where browsers and viewers reach a simulation (docs/viewing.md).
struct SimulationPage {
  std::uint16_t port = 8765;  // 0: any free one
  std::string address = "127.0.0.1";
};

class Simulation {
 public:
  // `scenario` is the text of a scenario; `file` stands in messages, and its project is where paths begin. Its checks
  // are not looked at, and it has no end. Throws InputError with all mistakes.
  Simulation(const std::string& scenario, const std::filesystem::path& file, std::uint64_t seed);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  // One control period of all robots, then the world's. Throws std::runtime_error when the model fails.
  void step();
  std::int64_t time_ns() const noexcept;      // at which the next step begins
  std::int64_t period_ns() const noexcept;    // of a step
  std::uint64_t state_hash() const noexcept;  // over all steps
  std::vector<SaidLine> take_lines();         // since the last call; call it in each step

  // Before the first step, each at most once, the record first; neither changes a bit of the run. The record is that of
  // `kadans sim`, but only this program can repeat it. With the page the run keeps to the clock, or to the speed that
  // whoever looks at it asks for. Throw InputError.
  void record(const SimulationRecord& record);
  void show(const SimulationPage& page);
  // After the last step. Throws std::runtime_error when the record is not complete.
  void end_record(const std::map<std::string, std::string>& result);

  World& world() noexcept;
  std::size_t object(std::string_view name) const;  // throws std::invalid_argument where there is none

  // Robots by number: 0 is the scenario's own, then `robots` in their order. Throws std::out_of_range.
  std::size_t robots() const noexcept;
  WorldRobot& robot(std::size_t number);
  const Catalog& catalog(std::size_t number) const;      // its model, signals, and entries of the world model
  double signal(std::size_t number, SignalId id) const;  // as of its last control tick
  const RobotStatus& status(std::size_t number) const;   // what it knows of itself; the same
  // To its world model, in the next tick of its supervisor. Throws std::invalid_argument where it has none.
  void observe(std::size_t number, const Observation& observation);
  // What the scenario's perception of this robot said since the last call: its world model hears it, too. Call it in
  // each step, or never.
  std::vector<Observation> take_observed(std::size_t number);
  // The entry of its world model with this name. Throws std::invalid_argument.
  std::uint32_t entry(std::size_t number, std::string_view name) const;

 private:
  class Stepped;
  std::unique_ptr<Stepped> stepped_;
};

}  // namespace kadans
