// A robot from sensors to drives as a test of the failure contract needs it: its sensors can be made to fail, its
// control objects to write nonsense, and what goes to the plant is looked at in every tick.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/behavior_engine.h"
#include "engine/tick/control_engine.h"
#include "saboteur.h"
#include "scenario/disturb/planned_faults.h"
#include "written_watch.h"

namespace kadans::failures {

inline constexpr std::int64_t period_ns = 1'000'000;

// Keeps what it is told and what its motors say; everything else is another plant's.
class ListeningPlant final : public WorldAround {
 public:
  explicit ListeningPlant(World& world) : WorldAround(world) {}
  void read(SensorFrame& sensors) noexcept override {
    robot_.read(sensors);
    for (std::size_t i = 0; i < sensors.joint_count; ++i) motor_Nm_[i] = sensors.joints[i].motor_effort_Nm;
  }
  void write(const ActuationFrame& actuation) noexcept override {
    written_ = actuation;
    robot_.write(actuation);
  }
  const ActuationFrame& written() const noexcept { return written_; }
  double motor_Nm(std::size_t joint) const noexcept { return motor_Nm_[joint]; }

 private:
  ActuationFrame written_;
  std::array<double, max_joints> motor_Nm_{};
};

// What a rig keeps references to.
struct RigParts {
  const RobotModel& model;
  World& plant;
  Catalog& catalog;
  std::vector<std::unique_ptr<ControlObject>> objects;  // the first one becomes the saboteur's
  EngineSettings engine{};
  EstimateSettings estimate{};
  SafetySettings safety{};
  std::uint64_t seed = 1;
};

class Rig {
 public:
  explicit Rig(RigParts parts);

  // One tick, `dt_ns` after the last, with `missed` skipped between them; every tenth is the behavior engine's too,
  // unless it is dead.
  void tick(std::int64_t dt_ns = period_ns, std::uint32_t missed = 0);
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  // From now on, until play_nothing().
  void play(BehaviorHost& host) { behaviors.emplace(sets, *exchange, &host); }
  void play_nothing() { behaviors.emplace(sets, *exchange, nullptr); }

  // A transaction of one command, made `age_ns` ago.
  void send(const Command& command, std::int64_t age_ns = 0);
  void clear_faults() { send({.kind = CommandKind::clear_faults}); }
  // Of the first control object; joint as in the model.
  Command to(std::size_t joint, double position_rad, double duration_s) const;
  void move(std::size_t joint, double position_rad, double duration_s) { send(to(joint, position_rad, duration_s)); }
  void move(const std::string& pose, double duration_s);
  // From the next reading on.
  void spoil(ScenarioFault::Kind kind, SensorKind place, std::size_t index = 0, double size = 0) {
    faulty.add({.kind = kind, .place = place, .index = index, .from_ns = time_ns + 1, .size = size});
  }
  void heal() { faulty.clear(); }

  // Tick of the first fault of this kind since the start; -1 when there was none.
  std::int64_t first(FaultCode code) const;
  // Whether it was found, within the promised ticks from `shows` on, the first tick whose data show the fault.
  bool in_time(FaultCode code, std::int64_t shows) const;
  std::string codes() const;  // of the faults, in the order they came
  const SafetySettings& limits() const noexcept { return safety.settings(); }
  const std::string& broken_promise() const noexcept { return watch.broken(); }
  std::int64_t ticks() const noexcept { return static_cast<std::int64_t>(control.ticks()); }
  double position_rad(std::size_t joint) const { return plant.truth().position_rad[joint]; }
  double signal(const std::string& name) const { return control.row()[catalog.signals.find(name).value()]; }

  const RobotModel& model;
  FaultyPlant faulty;
  ListeningPlant plant;
  Catalog& catalog;
  Saboteur* saboteur = nullptr;
  ControlSets sets;
  Estimator estimator;
  Safety safety;
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control;
  std::optional<BehaviorEngine> behaviors;
  CommandSender sender;
  WrittenWatch watch;
  bool behaviors_alive = true;
  std::int64_t time_ns = 0;
  std::vector<Fault> faults;

 private:
  std::vector<std::unique_ptr<ControlObject>> sabotaged(std::vector<std::unique_ptr<ControlObject>> objects);
};

}  // namespace kadans::failures
