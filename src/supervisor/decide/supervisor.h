// The supervisor of one robot: it keeps the world model and runs the decisions, 10 to 30 times a second, on virtual
// time in lockstep or in a thread of its own. One tick of it:
//
//   1. it takes what the behavior thread showed: the snapshot, the odometry's past, what plays
//   2. it takes the observations that have come since, and forgets what is too old
//   3. it publishes the world model, which the control engine shows in the snapshot (s.seen)
//   4. it lets the decisions step, and sends what they ask for
//   5. it publishes its heartbeat
//
// Supervisor thread, but for what is said to be before the loop.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "config/robot/supervisor_config.h"
#include "decision_process.h"
#include "engine/behavior_inputs.h"
#include "engine/behavior_log.h"
#include "engine/supervising.h"
#include "engine/tick/control_engine.h"
#include "kadans/signal/observation.h"
#include "kadans/supervisor/odometry_past.h"
#include "kadans/supervisor/world_model.h"
#include "script/bindings/signal_expressions.h"
#include "script/host/file_watch.h"
#include "supervisor/messages/message_channel.h"
#include "supervisor/messages/robot_messages.h"
#include "supervisor_link.h"

namespace kadans {

// How decisions are loaded, here or in a process of their own.
Behavior::Settings decision_settings(const SupervisorConfig& config, const std::filesystem::path& root,
                                     const PlayFolders& folders, std::uint64_t seed, bool on_wall_clock);

class Supervisor final : public Supervising, public ObservationSink {
 public:
  struct Settings {
    SupervisorConfig config;
    std::filesystem::path root;  // of the project
    PlayFolders folders{};
    std::uint64_t seed = 1;
    bool on_wall_clock = false;
    // How messages go between robots, and where what is seen comes in; nullptr: nowhere.
    MessageChannel* messages = nullptr;
    MessageChannel* perception = nullptr;
    std::uint32_t boot = 1;          // of the messages: another number for each start
    DecisionProcess::Start start{};  // of a process in which the decisions run; none: they run here
  };
  static constexpr std::size_t observations_max = 256;  // that wait for a tick
  static constexpr std::size_t datagrams_max = 64;      // of each kind that are read in a tick

  // Before the loop. Keeps references, and publishes the empty world model. Throws InputError with what is wrong in the
  // file of the decisions.
  Supervisor(const Settings& settings, Catalog& catalog, SupervisorLink& link, SeenStorage& seen, BehaviorLog& log);

  // Before the loop: supervisor.*, and those of the decisions as of a behavior, whose states it adds.
  void declare_signals(SignalTable& signals, std::vector<SignalState>& states);
  // Before the loop: saved files of the decisions are reloaded. Throws std::runtime_error when nothing can be watched.
  void watch();

  // Before the loop: what the decisions take is told, so that they can be repeated; nullptr: to nobody. In each of
  // their ticks what is seen comes first; what plays comes before what was decided.
  void take_inputs_by(BehaviorInputs* inputs) noexcept {
    if (process_ != nullptr) return process_->take_inputs_by(inputs, &world_.entries());
    inputs_ = inputs;
  }

  std::int64_t period_ns() const noexcept override { return period_ns_; }
  void tick(std::int64_t time_ns) noexcept override;
  // Waits for the next tick; what finds no place is counted.
  void observe(const Observation& observation) noexcept override;

  const WorldModel& world() const noexcept { return world_; }
  const Decider* decider() const noexcept { return decider_; }              // nullptr: nothing decides
  const Decisions* decisions() const noexcept { return decisions_.get(); }  // that run here
  Decisions* decisions() noexcept { return decisions_.get(); }              // the same, of a run that is repeated
  const ProcessHost* process() const noexcept { return process_ ? &process_->process() : nullptr; }

 private:
  struct Status {  // for the record: relaxed atomics as in BehaviorStatus
    std::atomic<std::uint32_t> ticks{0}, observations{0}, refused{0}, orders{0}, failed{0};
    std::atomic<std::uint32_t> sent{0}, unsent{0}, heard{0}, unheard{0};  // messages
  };

  void take_perception(std::int64_t time_ns);
  void take_messages(std::int64_t time_ns);
  void tell_heard(const Decider::Heard& heard);
  void send_messages();
  void warn_once(std::string_view about, const std::string& text);
  void take_observations(std::int64_t time_ns) noexcept;
  bool step(std::int64_t time_ns);
  bool decide();
  void send_orders();
  void reload_saved();

  std::int64_t period_ns_;
  SupervisorLink& link_;
  SeenStorage& seen_;
  BehaviorLog& log_;
  WorldModel world_;
  OdometryPast past_;
  RobotMessages messages_;
  MessageChannel *message_channel_, *perception_channel_;
  std::vector<Observation> perceived_;
  std::set<std::string, std::less<>> warned_;  // what is told only once
  BehaviorInputs* inputs_ = nullptr;
  std::unique_ptr<Decisions> decisions_;
  std::unique_ptr<DecisionProcess> process_;
  Decider* decider_ = nullptr;  // one of the two
  std::unique_ptr<FileWatch> watch_;
  std::array<Observation, observations_max> waiting_{};
  std::size_t waiting_count_ = 0;
  Snapshot snapshot_;  // with the world model as it is now
  PlayReport report_;
  std::uint32_t lost_ = 0;  // orders that found no place on their way to the behaviors
  bool lost_now_ = false;
  std::uint32_t beats_ = 0;  // ticks in which somebody decided
  bool ended_ = false;       // by an exception
  Status status_;
};

}  // namespace kadans
