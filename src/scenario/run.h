// One run of a scenario on the virtual clock, from the first tick to the result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/behavior_log.h"
#include "engine/lockstep.h"
#include "kadans/plant/world.h"
#include "kadans/signal/state_hash.h"
#include "plant/joystick/stick.h"
#include "recorded_perception.h"
#include "scenario/disturb/disturbances.h"
#include "scenario/disturb/planned_faults.h"
#include "scenario/judge/checks.h"
#include "scenario/judge/truth_signals.h"
#include "simulated_perception.h"

namespace kadans {

// The log of a run. It keeps transitions and messages for the run's report. The number that is kept is
// bounded, for runs without an end.
struct LogLine {
  std::int64_t time_ns = 0;
  BehaviorLog::Severity severity = BehaviorLog::Severity::info;
  std::string behavior;
  std::string text;
};

class RunLog final : public BehaviorLog, private LineSink {
 public:
  // Keeps the newest `kept_max` transitions and as many lines, at most twice as many. `sinks` hear all lines too.
  explicit RunLog(std::initializer_list<LineSink*> sinks = {}, std::size_t kept_max = SIZE_MAX / 2)
      : BehaviorLog(sinks), kept_max_(kept_max) {
    add(*this);
  }

  const std::vector<Transition>& transitions() const noexcept { return transitions_; }
  const std::vector<LogLine>& lines() const noexcept { return lines_; }
  const ActiveNow& active() const noexcept { return active_; }
  bool has_errors() const noexcept { return errors_; }  // also when their lines are no longer kept

 private:
  void tell(const Line& line) override;
  void tell_active(const ActiveStates& active) override { active_.take(active); }

  std::size_t kept_max_;
  bool errors_ = false;
  std::vector<Transition> transitions_;
  std::vector<LogLine> lines_;
  ActiveNow active_;
};

struct RunParts {
  World& world;
  WorldRobot& robot;
  ControlEngine& control;
  BehaviorEngine& behaviors;
  Lockstep& lockstep;
  TruthSignals& truth;
  const RobotModel& model;
  RunLog& log;
  Disturbances* disturbances = nullptr;
  JoystickSource* joystick = nullptr;
  SimulatedSight* sight = nullptr;
  std::vector<SimulatedPerception*> perception{};
  std::vector<RecordedPerception*> recorded{};  // likewise, of recorded runs
  ObservationSink* observed = nullptr;          // who takes what perception says
  // Signals that are no part of the state hash, rising: the interpreter's own needs (memory, instructions, pauses),
  // because memory depends on the machine; and odometry, which follows from what is in the hash.
  std::vector<SignalId> unhashed{};
  std::string name{};                   // of a further robot
  const FaultyPlant* faulty = nullptr;  // of a further robot; nullptr: its plant has no faults
  std::vector<RunParts> others{};       // of the world's further robots; their signals are among the first robot's

  // What comes before a step: the truth of each robot as signals, disturbances, the joystick, perception.
  void begin_step() const;
};

// The progress of a run between two ticks.
struct RunMark {
  std::uint64_t ticks = 0;       // completed ticks
  std::int64_t time_ns = 0;      // time at which the next tick begins
  std::uint64_t state_hash = 0;  // over all completed ticks
};

// Steps a run, and keeps the hash of its states. Keeps a reference to the parts: what is taken out of them between two
// steps (disturbances) is no more.
class RunSteps {
 public:
  explicit RunSteps(const RunParts& parts);

  // One control period of all robots and the world. Throws what the plant throws.
  void step();
  RunMark mark() const noexcept;  // after the last step

 private:
  const RunParts& parts_;
  std::vector<std::pair<std::size_t, std::size_t>> hashed_;  // stretches of a row: where, how many
  StateHash hash_;
};

// Observes a run while it goes. `row` holds all signals of the tick.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void tick(double /*time_s*/, std::span<const double> /*row*/) {}
  // Called for each fault that a robot's safety layer found; `fault.robot` says which robot's.
  virtual void fault(const Fault& fault) { (void)fault; }
  // Called after each tick and its step of the plant. Changes that it makes take effect in the next tick.
  virtual void between_ticks(const RunMark& mark) { (void)mark; }
  virtual bool stop_asked() const { return false; }
};

struct TickCost {
  double median_ns = 0, p99_ns = 0, max_ns = 0;
};

struct RunFault : Fault {
  ToldFault told;  // of a further robot with its name: "left.l_knee", or "left" alone
};

// The forces of a step in which contacts and joints were left open by more, m/s or rad/s, are not to be trusted.
inline constexpr double residual_trusted_m_s = 0.01;

struct RunResult {
  std::string scenario;
  std::uint64_t seed = 0;
  bool passed = false;  // every check passed, no behavior had an error, the run was not stopped early
  bool interrupted = false;
  std::string error;  // why the run ended early; "" when it did not
  std::vector<CheckResult> checks;
  double duration_s = 0;
  double wall_s = 0;
  double realtime_factor = 0;
  std::uint64_t control_ticks = 0, behavior_ticks = 0;
  std::uint64_t state_hash = 0;
  std::uint64_t unsettled_steps = 0;  // which left more open than residual_trusted_m_s
  double residual_max_m_s = 0, residual_max_at_s = 0;
  TickCost tick;
  std::uint64_t commands_sent = 0, commands_refused = 0;
  std::vector<RunFault> faults;  // of all robots, in the order of time, at most fault_log_capacity of each in a tick
};

// Runs for duration_s of simulated time. `observers` may be empty. When the plant throws, the run ends and the result
// holds the error.
RunResult run_scenario(const RunParts& parts, double duration_s, Checks& checks,
                       const std::vector<RunObserver*>& observers);

}  // namespace kadans
