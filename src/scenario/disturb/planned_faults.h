// Injects faults at the times that a scenario plans: into sensors, drives and supply of the plant, and into the
// commands of behaviors.
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "config/scenario/scenario_config.h"
#include "engine/behavior_host.h"
#include "engine/settings.h"
#include "kadans/plant/world.h"
#include "kadans/signal/random.h"
#include "quantities.h"

namespace kadans {

enum class SensorKind : std::uint8_t { joint, imu, foot, channel };

// A fault of a scenario with its place in the robot found:
//
//   sensor_silent      no new reading
//   sensor_stuck       new readings with the value that the sensor had when the fault began
//   sensor_offset      `size` is added
//   sensor_noise       a random value is added to each reading: half to all of `size`, of either sign
//   sensor_jump        `size` is added to one reading
//   sensor_not_finite  NaN
//   drive_dead         no torque
//   drive_weak         the effort is multiplied by `size`; no effect in position and velocity mode
//   drive_stuck        repeats what was written last before the fault
//   drive_offset       `size` is added to the effort, Nm
//   drive_late         applies what was written `size` ticks before
//   drive_tripped      says that it is in fault, with the maker's code `size`; no torque; a reset makes it disabled
//   drive_disabled     says that it is ready but not enabled; no torque; an order to enable it ends the fault
//   drive_hot          says that its temperature is `size` C
//   drive_old          its readings are `size` s old
//   supply             the supply voltage is `size` V
//   emergency_button   the emergency stop is pressed
//   commands_...       lost, late by `size` behavior ticks, not finite
struct PlannedFault {
  ScenarioFault::Kind kind = ScenarioFault::Kind::sensor_silent;
  SensorKind place = SensorKind::joint;
  // Of the joint, foot or channel; of a drive its place: of coupled drives, drive i stands where joint i does
  // (transmission.h).
  std::size_t index = 0;
  std::int64_t from_ns = 0;
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  // not included
  double size = 0;  // of a joint: rad, its position; IMU: rad/s about x; foot: N on the first sensor; channel: in its
                    // own unit

  bool is_now(std::int64_t time_ns) const noexcept { return time_ns >= from_ns && time_ns < until_ns; }
};

// Injects faults into sensors, drives and supply at planned times. It is a world around a robot of another world: it
// changes what is read from the robot and what is written to it. Everything else passes through.
//
// Call add() and clear() on the thread that owns the model. read() and write() neither allocate nor throw.
class FaultyPlant final : public WorldAround {
 public:
  // Keeps a reference to `world`. `seed` is that of the run, `robot` the number of the robot that has the faults,
  // `transmissions` are that robot's.
  FaultyPlant(World& world, std::uint64_t seed, std::size_t robot = 0,
              std::span<const Transmission> transmissions = {});

  static constexpr std::size_t late_ticks_max = 255;

  void add(const PlannedFault& fault);  // throws std::invalid_argument for one of commands
  // Removes all faults of sensors, drives and supply.
  void clear() noexcept {
    sensor_faults_.clear();
    drive_faults_.clear();
    supply_faults_.clear();
  }

  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void hash(StateHash& hash) const noexcept override;
  // Of this robot alone: what its faults hold back, and the actuation that is under way to its late drives. Needed for
  // a further robot, whose faults are not in the hash of the first one's world.
  void hash_held_back(StateHash& hash) const noexcept;

 private:
  struct OfSensor {
    PlannedFault fault;
    SensorFrame first;  // what was read when the fault began
    bool begun = false;
  };
  struct OfDrive {
    PlannedFault fault;
    JointActuation held;          // what was written last before the fault began
    std::uint8_t order_seen = 0;  // number of the drive's last order
    bool over = false;            // an order to the drive ended the fault

    bool is_now(std::int64_t time_ns) const noexcept { return !over && fault.is_now(time_ns); }
    void heed(const DriveRequest& request, std::int64_t time_ns) noexcept;
  };
  void spoil(OfSensor& planned, SensorFrame& sensors) noexcept;
  void spoil(OfDrive& planned, JointActuation& actuation) const noexcept;
  static std::size_t late_ticks(const PlannedFault& fault) noexcept;
  const ActuationFrame& written_before(std::size_t ticks) const noexcept {
    return written_[(newest_ + written_.size() - ticks) % written_.size()];
  }

  RandomStream random_;
  std::vector<OfSensor> sensor_faults_;
  std::vector<OfDrive> drive_faults_;
  std::vector<PlannedFault> supply_faults_;
  std::int64_t time_ns_ = 0;  // of the last read
  DriveRequests asked_{};     // in the last write
  std::vector<Transmission> couplings_;
  std::vector<ActuationFrame> written_;  // to the drives: ring of the last frames; empty when no drive is late
  std::size_t newest_ = 0;
};

// Injects faults into the commands of behaviors at planned times: they are lost, late or not finite. It stands between
// the behavior engine and the host that runs the behaviors. Behavior thread.
class FaultyHost final : public BehaviorHost {
 public:
  explicit FaultyHost(BehaviorHost& host) : host_(host), queue_(std::make_unique<CommandQueue>()), own_(*queue_) {}
  void add(const PlannedFault& fault);  // throws std::invalid_argument for one of sensors, drives or supply

  void tick(const Snapshot& snapshot, CommandSender& commands) noexcept override;

 private:
  struct Batch {
    std::uint64_t due_tick = 0;
    std::int64_t time_ns = 0;
    std::vector<Command> commands;
  };
  void collect(std::int64_t time_ns);
  void forward(CommandSender& commands);

  BehaviorHost& host_;
  std::unique_ptr<CommandQueue> queue_;
  CommandSender own_;
  std::vector<PlannedFault> faults_;
  std::deque<Batch> under_way_;
  std::uint64_t tick_ = 0;
};

// Makes the wrappers that inject a scenario's faults into the plant and into the behaviors' commands.

// Wraps a robot of the world when the scenario has faults of sensors, drives or supply, or a delay of the actuation;
// else returns nullptr. Throws InputError for names that the robot does not have.
std::unique_ptr<FaultyPlant> make_faulty_plant(const ScenarioConfig& scenario, const PlantVariant& variant,
                                               const EngineSettings& engine, std::uint64_t seed, World& world,
                                               std::size_t robot = 0);

// Wraps the host of the behaviors when the scenario has faults of commands; else returns nullptr.
std::unique_ptr<FaultyHost> make_faulty_host(const ScenarioConfig& scenario, BehaviorHost& host);

}  // namespace kadans
