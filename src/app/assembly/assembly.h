// Assembles a robot from its files, and the further robots of its world. The order of the members is the way of the
// data; each member keeps references to earlier ones.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "assembled_plant.h"
#include "engine/lockstep.h"
#include "robot.h"
#include "scenario/disturb/disturbances.h"
#include "scenario/run.h"
#include "script/host/script_host.h"
#include "script/process/process_host.h"
#include "supervisor/decide/supervised_host.h"
#include "supervisor/decide/supervisor.h"
#include "supervisor/messages/datagrams.h"
#include "supervisor/messages/simulated_network.h"

namespace kadans {

// Makes the host of a scenario's behaviors. Throws InputError.
std::unique_ptr<ScriptHost> make_script_host(const ScenarioConfig& scenario, const RobotConfig& robot,
                                             const Catalog& catalog, std::uint64_t seed, BehaviorLog& log,
                                             std::span<const std::byte> kept = {});

class Assembly {
 public:
  // Reads the robot and the behaviors that the scenario names. Throws InputError with all mistakes. `scenario`,
  // `log`, `link` and what `outside` names must outlive the assembly. With `link` the world runs on a thread of its
  // own, and the engines use the other side of the link. What `outside` names runs in a process of its own, in a run on
  // the wall clock. When the scenario's plant is no model, there is no world: parts(), world() and truth() cannot be
  // used.
  //
  // Each further robot of the scenario gets an assembly of its own. What it does is among this robot's signals, as
  // NAME.<signal>, and its behaviors report as NAME.<behavior>.
  struct Outside {
    ProcessHost* behaviors = nullptr;    // plays them, and has been started with them
    DecisionProcess::Start decisions{};  // starts the process of the robot's decisions, if it has any
  };
  Assembly(const ScenarioConfig& scenario, std::uint64_t seed, RunLog& log, PlantExchange* link,
           const Outside& outside);
  Assembly(const ScenarioConfig& scenario, std::uint64_t seed, RunLog& log, PlantExchange* link = nullptr)
      : Assembly(scenario, seed, log, link, Outside()) {}
  template <typename... Rest>
  Assembly(ScenarioConfig&& scenario, Rest&&... rest) = delete;

  const RobotConfig& robot() const noexcept { return robot_.config; }
  const Catalog& catalog() const noexcept { return control_system_->catalog; }
  const ScriptHost& host() const noexcept { return *host_; }  // only when behaviors do not play outside
  ScriptHost& host() noexcept { return *host_; }
  std::span<const SignalState> signal_states() const noexcept { return states_; }  // of behaviors and decisions
  const ScriptHost* own_host() const noexcept { return host_.get(); }              // nullptr when they play outside
  OrderTaker& orders() noexcept {
    return outside_.behaviors != nullptr ? static_cast<OrderTaker&>(*outside_.behaviors) : *host_;
  }
  // Call before the run: from now on saved files are reloaded. Throws std::runtime_error when files cannot be watched.
  void watch_behaviors() {
    host_->watch();
    if (supervisor_) supervisor_->watch();
  }
  RunParts parts() { return parts_in(*lockstep_); }
  const ScenarioConfig& scenario() const noexcept { return scenario_; }
  const WorldSettings& world_settings() const noexcept { return variant_.plant.world; }  // of this run
  std::size_t object(std::string_view name) const;  // of that world; throws std::invalid_argument where there is none
  const std::vector<std::unique_ptr<Assembly>>& others() const noexcept { return others_; }
  ControlEngine& control() noexcept { return *control_; }
  ControlSets& sets() noexcept { return *sets_; }
  const ControlSets& sets() const noexcept { return *sets_; }
  BehaviorEngine& behaviors() noexcept { return *behaviors_; }
  Plant& plant() noexcept { return plant_.plant(); }  // not open yet
  // Through which the engine sees the plant when it has a thread of its own; else nullptr.
  LastWord* last_word() noexcept { return plant_.last_word(); }
  World* world() noexcept { return plant_.world(); }       // with its faults; nullptr: there is none
  TruthSignals* truth() noexcept { return truth_.get(); }  // nullptr: there is none
  // The quantities that were set or drawn for this run; further robots' as NAME.<quantity>.
  const std::vector<QuantityValue>& quantities() const noexcept { return quantities_; }
  void record_to(RecordSink* sink) noexcept { control_->record_to(sink); }

  // For a run that repeats a record: the signals that no engine computes are read from this row, which must outlive the
  // assembly. They are those of the plant, of a model's true state and, unless the behaviors' are their own, of what
  // plays.
  void read_foreign_signals_from(std::span<const double> row, bool of_behaviors);
  const std::vector<SignalId>& unhashed() const noexcept { return unhashed_; }  // no part of a state hash
  std::size_t foreign_first() const noexcept { return foreign_first_; }
  std::size_t foreign_end() const noexcept { return foreign_end_; }

  // What decides what is played; nullptr: nothing does. In a run on threads it is ticked by its own.
  Supervisor* supervisor() noexcept { return supervisor_.get(); }
  const Supervisor* supervisor() const noexcept { return supervisor_.get(); }
  // What people ask of the decisions; nullptr: nothing decides here.
  DecisionQuestions* decision_questions() noexcept {
    return supervised_ && supervisor_->decider() != nullptr ? &supervisor_link_->questions : nullptr;
  }
  // In which the decisions run; nullptr: they run here, or there are none.
  const ProcessHost* decision_process() const noexcept { return supervisor_ ? supervisor_->process() : nullptr; }
  // The scenario's or the robot's.
  const SupervisorConfig& supervising() const noexcept { return robot_.config.supervisor; }
  void stop_deciding() noexcept {
    if (supervised_) supervised_->leave();
  }

  // Call before the first step: from then on `change` changes, on the behavior thread, what the behaviors see. Tests
  // need this, because a robot on the ideal plant never falls by itself.
  void filter(std::function<void(Snapshot&)> change);

 private:
  struct Begun {};
  // Reads and varies the robot; complete() does the rest, once there is a world. Robot 0 is the first.
  Assembly(Begun, const ScenarioConfig& scenario, std::uint64_t seed, RunLog& log, PlantExchange* link,
           const Outside& outside, std::size_t number);
  void complete();
  RunParts parts_in(Lockstep& lockstep);
  void begin_others();
  void show_others();
  void vary();
  void start_in_pose();
  void make_plant();
  void make_joystick_player();
  void make_sight();
  void make_perception();
  void take_supervisor();
  void open_sockets();
  void make_supervisor(BehaviorLog& told);
  void make_behaviors();
  BehaviorHost& played() noexcept;

  const ScenarioConfig& scenario_;
  std::uint64_t seed_;
  std::size_t number_;  // in the world
  RunLog& log_;
  std::shared_ptr<BehaviorLog> named_log_;  // of a further robot
  PlantExchange* link_;
  Outside outside_;
  Robot robot_;
  PlantVariant variant_;
  std::vector<QuantityValue> quantities_;
  std::vector<ScenarioConfig> further_;  // as this scenario completes them
  AssembledPlant plant_;                 // the others' are in the first's world
  std::vector<std::unique_ptr<Assembly>> others_;
  std::unique_ptr<ControlSystem> control_system_;
  std::unique_ptr<ControlSets> sets_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<Safety> safety_;
  std::unique_ptr<EngineExchange> exchange_;
  std::unique_ptr<TruthSignals> truth_;
  std::unique_ptr<ScriptHost> host_;
  std::vector<SignalState> states_;
  std::size_t foreign_first_ = 0, foreign_end_ = 0;
  std::size_t upkeep_first_ = 0, upkeep_count_ = 0;  // the signals about the interpreter's own needs
  std::vector<SignalId> unhashed_;
  std::unique_ptr<SimulatedNetwork> network_;  // of all robots, the first robot's; in lockstep
  std::unique_ptr<MessageChannel> messages_, perceived_;
  MessageChannel* message_channel_ = nullptr;
  std::unique_ptr<SupervisorLink> supervisor_link_;
  BehaviorLog supervisor_log_;
  std::unique_ptr<Supervisor> supervisor_;
  std::unique_ptr<SupervisedHost> supervised_;
  std::unique_ptr<ControlEngine> control_;
  std::unique_ptr<FaultyHost> faulty_host_;
  std::unique_ptr<BehaviorHost> filtered_;
  std::unique_ptr<BehaviorEngine> behaviors_;
  std::unique_ptr<Lockstep> lockstep_;
  std::unique_ptr<Disturbances> disturbances_;
  std::unique_ptr<JoystickSource> joystick_;
  std::unique_ptr<SimulatedSight> sight_;
  std::vector<std::unique_ptr<SimulatedPerception>> perception_;
  std::vector<std::unique_ptr<RecordedPerception>> recorded_;
};

}  // namespace kadans
