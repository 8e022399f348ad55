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

// Injects faults into sensors, drives and supply at planned times. It is a world around a robot of another world: it
// changes what is read from the robot and what is written to it. Everything else passes through.
//
// Call add() and clear() on the thread that owns the model. read() and write() neither allocate nor throw.
enum class SensorFaultKind : std::uint8_t {
  silent,      // no new reading
  stuck,       // new readings with the value that the sensor had when the fault began
  offset,      // `size` is added
  noise,       // a random value is added to each reading: half to all of `size`, of either sign
  jump,        // `size` is added to one reading
  not_finite,  // NaN
};
enum class SensorKind : std::uint8_t { joint, imu, foot, channel };

struct SensorFault {
  SensorFaultKind kind = SensorFaultKind::silent;
  SensorKind place = SensorKind::joint;
  std::size_t index = 0;  // of the joint, foot or channel
  std::int64_t from_ns = 0;
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  // not included
  double size = 0;  // joint: rad, its position; IMU: rad/s about x; foot: N on the first sensor;
                    // channel: in its own unit
};

enum class ActuatorFaultKind : std::uint8_t {
  dead,    // no torque
  weak,    // the effort is multiplied by `size`; no effect in position and velocity mode
  stuck,   // repeats what was written last before the fault
  offset,  // `size` is added to the effort, Nm
  late,    // applies what was written `size` ticks before
  // What the drive reports of itself:
  tripped,   // it is in fault, with the maker's code `size`; no torque; a reset makes it `disabled`
  disabled,  // it is ready but not enabled; no torque; an order to enable it ends the fault
  hot,       // its temperature is `size` C
  old,       // its readings are `size` s old
};

struct ActuatorFault {
  ActuatorFaultKind kind = ActuatorFaultKind::dead;
  std::size_t joint = 0;  // the drive's place; of coupled drives, drive i stands where joint i does (transmission.h)
  std::int64_t from_ns = 0;
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  // not included
  double size = 0;
};

struct SupplyFault {
  bool button = false;  // the emergency stop is pressed; else the supply voltage is `supply_V`
  double supply_V = 0;
  std::int64_t from_ns = 0;
  std::int64_t until_ns = std::numeric_limits<std::int64_t>::max();  // not included
};

class FaultyPlant final : public OneRobotWorld {
 public:
  // Keeps a reference to `world`. `seed` is that of the run, `robot` the number of the robot that has the faults,
  // `transmissions` are that robot's.
  FaultyPlant(World& world, std::uint64_t seed, std::size_t robot = 0,
              std::span<const Transmission> transmissions = {});

  static constexpr std::size_t late_ticks_max = 255;

  void add(const SensorFault& fault) { faults_.push_back({fault, {}, false}); }
  void add(const ActuatorFault& fault);
  void add(const SupplyFault& fault) { supply_faults_.push_back(fault); }
  // Removes all faults of sensors, drives and supply.
  void clear() noexcept {
    faults_.clear();
    actuator_faults_.clear();
    supply_faults_.clear();
  }

  void declare_signals(SignalTable& table) const override { robot_.declare_signals(table); }
  std::vector<PlantCount> link_counts() const override { return robot_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override;
  void write(const ActuationFrame& actuation) noexcept override;
  void step(std::int64_t dt_ns) override { world_.step(dt_ns); }
  const PlantTruth& truth() const noexcept override { return robot_.truth(); }
  void push(std::size_t link, const Vec3& force_N, const Vec3& point_in_link_m) override {
    robot_.push(link, force_N, point_in_link_m);
  }
  void carry(double x_m, double y_m, double heading_rad) override { robot_.carry(x_m, y_m, heading_rad); }
  void put(std::size_t object, const Vec3& position_m) override { world_.put(object, position_m); }
  void hash(StateHash& hash) const noexcept override;
  // Of this robot alone: what its faults hold back, and the actuation that is under way to its late drives. Needed for
  // a further robot, whose faults are not in the hash of the first one's world.
  void hash_held_back(StateHash& hash) const noexcept;

 private:
  struct Planned {
    SensorFault fault;
    SensorFrame first;  // what was read when the fault began
    bool begun;
  };
  struct PlannedActuator {
    ActuatorFault fault;
    JointActuation held;          // what was written last before the fault began
    std::uint8_t order_seen = 0;  // number of the drive's last order
    bool over = false;            // an order to the drive ended the fault

    bool is_now(std::int64_t time_ns) const noexcept {
      return !over && time_ns >= fault.from_ns && time_ns < fault.until_ns;
    }
    void heed(const DriveRequest& request, std::int64_t time_ns) noexcept;
  };
  void spoil(Planned& planned, SensorFrame& sensors) noexcept;
  void spoil(PlannedActuator& planned, JointActuation& actuation) const noexcept;
  static std::size_t late_ticks(const ActuatorFault& fault) noexcept;
  const ActuationFrame& written_before(std::size_t ticks) const noexcept {
    return written_[(newest_ + written_.size() - ticks) % written_.size()];
  }

  World& world_;
  WorldRobot& robot_;
  RandomStream random_;
  std::vector<Planned> faults_;
  std::vector<PlannedActuator> actuator_faults_;
  std::vector<SupplyFault> supply_faults_;
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
  enum class Kind : std::uint8_t { lost, late, not_finite };
  struct Fault {
    Kind kind = Kind::lost;
    std::int64_t from_ns = 0, until_ns = 0;  // not included
    std::size_t ticks = 0;                   // for late: the delay in behavior ticks
  };

  explicit FaultyHost(BehaviorHost& host) : host_(host), queue_(std::make_unique<CommandQueue>()), own_(*queue_) {}
  void add(const Fault& fault) { faults_.push_back(fault); }

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
  std::vector<Fault> faults_;
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
