// A robot light enough for ten thousand runs: four joints, two feet and an IMU with noise, without physics to speak of.
// Its control object can be told to write nonsense; what is written to the plant is looked at in every tick.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kadans/control/joint_pid.h"
#include "kadans/engine/behavior_engine.h"
#include "kadans/engine/control_engine.h"
#include "kadans/plant/ideal_plant.h"
#include "kadans/scenario/faulty_plant.h"

namespace kadans::failures {

inline constexpr std::size_t joints = 4;
inline constexpr std::int64_t period_ns = 1'000'000;

// The ideal plant with feet and noise.
class NoisyPlant final : public ModelPlant {
 public:
  NoisyPlant(const RobotModel& model, const PlantSettings& settings, std::uint64_t seed)
      : ideal_(model, settings), random_(seed, "light robot") {}
  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override { ideal_.write(actuation); }
  void step(std::int64_t dt_ns) override { ideal_.step(dt_ns); }
  const PlantTruth& truth() const noexcept override { return ideal_.truth(); }
  void push(std::size_t, const Vec3&, const Vec3&) override {}
  void hash(StateHash& hash) const noexcept override { ideal_.hash(hash); }

 private:
  IdealPlant ideal_;
  RandomStream random_;
};

// A joint PID whose output for one joint is replaced once it is armed.
class Saboteur final : public ControlObject {
 public:
  explicit Saboteur(const ObjectSetup& setup) : pid_(setup) {}
  void arm(std::size_t joint, double effort_Nm) noexcept {
    joint_ = joint;
    effort_Nm_ = effort_Nm;
    armed_ = true;
  }
  void declare(Declaration& declaration) override { pid_.declare(declaration); }
  void start(const ControlInput& input) noexcept override { pid_.start(input); }
  void step(const ControlInput& input, ActuationFrame& actuation) noexcept override {
    pid_.step(input, actuation);
    if (armed_) actuation.joints[joint_].effort_Nm = effort_Nm_;
  }
  void set_point(std::uint32_t channel, double value, double duration_s) noexcept override {
    pid_.set_point(channel, value, duration_s);
  }
  void cancel_motion(std::uint32_t channel) noexcept override { pid_.cancel_motion(channel); }
  double motion_remaining_s() const noexcept override { return pid_.motion_remaining_s(); }

 private:
  JointPid pid_;
  std::size_t joint_ = 0;
  double effort_Nm_ = 0;
  bool armed_ = false;
};

class LightRobot {
 public:
  explicit LightRobot(std::uint64_t seed, BehaviorHost* host = nullptr);

  // One tick, `dt_ns` after the last, with `missed` skipped between them; every tenth is the behavior engine's too,
  // unless it is dead.
  void tick(std::int64_t dt_ns = period_ns, std::uint32_t missed = 0);
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) tick();
  }
  // A transaction of one command, made `age_ns` ago.
  void send(const Command& command, std::int64_t age_ns = 0);
  void move(std::size_t joint, double position_rad, double duration_s) {
    send({.kind = CommandKind::set_point,
          .index = static_cast<std::uint32_t>(joint),
          .value = position_rad,
          .duration_s = duration_s});
  }

  // Tick of the first fault of this kind since the start; -1 when there was none.
  std::int64_t first(FaultCode code) const;
  const SafetySettings& limits() const noexcept { return safety.settings(); }
  std::int64_t ticks() const noexcept { return static_cast<std::int64_t>(control.ticks()); }

  EngineSettings settings;
  RobotModel model;
  NoisyPlant sound;
  FaultyPlant plant;
  Catalog catalog;
  Saboteur* saboteur = nullptr;
  ControlSets sets;
  Estimator estimator;
  Safety safety;
  std::unique_ptr<EngineExchange> exchange = std::make_unique<EngineExchange>();
  ControlEngine control;
  BehaviorEngine behaviors;
  CommandSender sender;
  bool behaviors_alive = true;
  std::int64_t time_ns = 0;
  std::vector<Fault> faults;
  std::string broken_promise;  // the first thing written that must never be

 private:
  std::vector<std::unique_ptr<ControlObject>> objects();
  void look_at_what_was_written();

  std::vector<SignalId> written_;
};

}  // namespace kadans::failures
