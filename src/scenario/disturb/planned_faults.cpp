
#include "planned_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace kadans {
namespace {

// The one value of a sensor that an error of some size is added to.
double& value_of(const SensorFault& fault, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::imu) return frame.imu.angular_velocity_rad_s[0];
  if (fault.place == SensorKind::channel) return frame.channels[fault.index].value;
  return fault.place == SensorKind::foot ? frame.feet[fault.index].force_N[0] : frame.joints[fault.index].position_rad;
}

// All that the sensor says is as it was in `from`, but for the sequence numbers.
void repeat(const SensorFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index].position_rad = from.joints[fault.index].position_rad;
  if (fault.place == SensorKind::foot) frame.feet[fault.index].force_N = from.feet[fault.index].force_N;
  if (fault.place == SensorKind::channel) frame.channels[fault.index].value = from.channels[fault.index].value;
  if (fault.place != SensorKind::imu) return;
  frame.imu.angular_velocity_rad_s = from.imu.angular_velocity_rad_s;
  frame.imu.acceleration_m_s2 = from.imu.acceleration_m_s2;
}

void silence(const SensorFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index] = from.joints[fault.index];
  if (fault.place == SensorKind::foot) frame.feet[fault.index] = from.feet[fault.index];
  if (fault.place == SensorKind::channel) frame.channels[fault.index] = from.channels[fault.index];
  if (fault.place == SensorKind::imu) frame.imu = from.imu;
}

// Of any kind of fault.
template <typename Fault>
bool is_now(const Fault& fault, std::int64_t time_ns) noexcept {
  return time_ns >= fault.from_ns && time_ns < fault.until_ns;
}

// What a drive that fails says of itself.
void tell(const ActuatorFault& fault, std::int64_t time_ns, JointSample& sample) noexcept {
  switch (fault.kind) {
    case ActuatorFaultKind::tripped:
      sample.drive = DriveState::fault;
      sample.code = static_cast<std::uint32_t>(fault.size);
      break;
    case ActuatorFaultKind::disabled:
      sample.drive = DriveState::ready;
      break;
    case ActuatorFaultKind::hot:
      sample.temperature_C = static_cast<float>(fault.size);
      break;
    case ActuatorFaultKind::old:
      sample.time_ns = time_ns - static_cast<std::int64_t>(1e9 * fault.size);
      break;
    default:
      break;
  }
}

}  // namespace

FaultyPlant::FaultyPlant(World& world, std::uint64_t seed, std::size_t robot,
                         std::span<const Transmission> transmissions)
    : world_(world), robot_(world.robot(robot)), random_(seed, "sensor faults") {
  std::ranges::copy_if(transmissions, std::back_inserter(couplings_), &Transmission::coupled);
}

void FaultyPlant::read(SensorFrame& sensors) noexcept {
  const SensorFrame before = sensors;  // a silent sensor repeats what it said last, sequence number included
  robot_.read(sensors);
  time_ns_ = sensors.time_ns;
  for (Planned& planned : faults_) {
    const SensorFault& fault = planned.fault;
    if (!is_now(fault, sensors.time_ns)) continue;
    if (!planned.begun) planned.first = fault.kind == SensorFaultKind::silent ? before : sensors;
    spoil(planned, sensors);
    planned.begun = true;
  }
  for (const PlannedActuator& planned : actuator_faults_) {
    const ActuatorFault& fault = planned.fault;
    if (planned.is_now(sensors.time_ns)) tell(fault, sensors.time_ns, sensors.joints[fault.joint]);
  }
  for (const SupplyFault& fault : supply_faults_) {
    if (!is_now(fault, sensors.time_ns)) continue;
    if (fault.button) sensors.emergency = true;
    if (!fault.button) sensors.supply_V = fault.supply_V;
  }
}

void FaultyPlant::spoil(Planned& planned, SensorFrame& sensors) noexcept {
  const SensorFault& fault = planned.fault;
  double& value = value_of(fault, sensors);
  switch (fault.kind) {
    case SensorFaultKind::silent:
      silence(fault, planned.first, sensors);
      break;
    case SensorFaultKind::stuck:
      repeat(fault, planned.first, sensors);
      break;
    case SensorFaultKind::offset:
      value += fault.size;
      break;
    case SensorFaultKind::noise: {
      const double draw = random_.uniform(-1, 1);
      value += fault.size * (draw < 0 ? 0.5 * draw - 0.5 : 0.5 * draw + 0.5);
      break;
    }
    case SensorFaultKind::jump:
      if (!planned.begun) value += fault.size;
      break;
    case SensorFaultKind::not_finite:
      value = std::numeric_limits<double>::quiet_NaN();
      break;
  }
}

// A drive that has tripped is reset, then enabled.
void FaultyPlant::PlannedActuator::heed(const DriveRequest& request, std::int64_t time_ns) noexcept {
  if (!request.is_new(order_seen) || !is_now(time_ns)) return;
  if (fault.kind == ActuatorFaultKind::disabled && request.order == DriveOrder::enable) over = true;
  if (fault.kind == ActuatorFaultKind::tripped && request.order == DriveOrder::reset)
    fault.kind = ActuatorFaultKind::disabled;
}

void FaultyPlant::add(const ActuatorFault& fault) {
  if (fault.kind == ActuatorFaultKind::late && written_.empty()) written_.resize(late_ticks_max + 1);
  actuator_faults_.push_back({.fault = fault, .held = {}, .order_seen = asked_[fault.joint].number});
}

std::size_t FaultyPlant::late_ticks(const ActuatorFault& fault) noexcept {
  return static_cast<std::size_t>(std::clamp(fault.size, 0.0, double{late_ticks_max}));
}

void FaultyPlant::spoil(PlannedActuator& planned, JointActuation& actuation) const noexcept {
  const ActuatorFault& fault = planned.fault;
  if (!planned.is_now(time_ns_)) {
    planned.held = actuation;
    return;
  }
  switch (fault.kind) {
    case ActuatorFaultKind::hot:
    case ActuatorFaultKind::old:
      break;
    case ActuatorFaultKind::dead:
    case ActuatorFaultKind::tripped:
    case ActuatorFaultKind::disabled:
      actuation = {};
      break;
    case ActuatorFaultKind::weak:
      actuation.effort_Nm *= fault.size;
      break;
    case ActuatorFaultKind::stuck:
      actuation = planned.held;
      break;
    case ActuatorFaultKind::offset:
      actuation.effort_Nm += fault.size;
      break;
    case ActuatorFaultKind::late:
      actuation = written_before(late_ticks(fault)).joints[fault.joint];
      break;
  }
}

void FaultyPlant::write(const ActuationFrame& actuation) noexcept {
  ActuationFrame spoiled = actuation;
  for (const Transmission& coupling : couplings_) coupling.to_drives(spoiled);
  if (!written_.empty()) {
    newest_ = (newest_ + 1) % written_.size();
    written_[newest_] = spoiled;
  }
  for (PlannedActuator& planned : actuator_faults_) {
    planned.heed(actuation.drives[planned.fault.joint], time_ns_);
    spoil(planned, spoiled.joints[planned.fault.joint]);
  }
  asked_ = actuation.drives;
  robot_.write_drives(spoiled);
}

void FaultyPlant::hash(StateHash& hash) const noexcept {
  world_.hash(hash);
  for (const PlannedActuator& planned : actuator_faults_) hash.add(planned.held.effort_Nm);
}

void FaultyPlant::hash_held_back(StateHash& hash) const noexcept {
  const auto add = [&hash](const JointActuation& actuation) {
    hash.add(static_cast<std::uint8_t>(actuation.mode));
    for (const double value : {actuation.position_rad, actuation.velocity_rad_s, actuation.effort_Nm}) hash.add(value);
  };
  for (const PlannedActuator& planned : actuator_faults_) {
    add(planned.held);
    hash.add(static_cast<std::uint8_t>(planned.fault.kind));
    hash.add(planned.over);
    if (planned.fault.kind != ActuatorFaultKind::late) continue;
    for (std::size_t age = 0; age < late_ticks(planned.fault); ++age)
      add(written_before(age).joints[planned.fault.joint]);
  }
}

void FaultyHost::tick(const Snapshot& snapshot, CommandSender& commands) noexcept {
  host_.tick(snapshot, own_);
  collect(snapshot.time_ns);
  forward(commands);
  ++tick_;
}

// Takes what the host sent in this tick and applies the faults of this moment to it.
void FaultyHost::collect(std::int64_t time_ns) {
  const std::size_t before = under_way_.size();
  Command command;
  while (queue_->try_pop(command)) {
    if (command.kind == CommandKind::transaction) {
      under_way_.push_back({.due_tick = tick_, .time_ns = command.time_ns, .commands = {}});
    } else {
      under_way_.back().commands.push_back(command);
    }
  }
  for (const Fault& fault : faults_) {
    if (time_ns < fault.from_ns || time_ns >= fault.until_ns) continue;
    for (std::size_t i = before; i < under_way_.size(); ++i) {
      Batch& batch = under_way_[i];
      if (fault.kind == Kind::late) batch.due_tick += fault.ticks;
      if (fault.kind == Kind::lost) batch.commands.clear();
      if (fault.kind != Kind::not_finite) continue;
      for (Command& each : batch.commands) each.value = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

void FaultyHost::forward(CommandSender& commands) {
  while (!under_way_.empty() && under_way_.front().due_tick <= tick_) {
    const Batch& batch = under_way_.front();
    commands.begin(batch.time_ns);
    for (const Command& command : batch.commands) (void)commands.add(command);  // refused whole when it does not fit
    (void)commands.commit();
    under_way_.pop_front();
  }
}

namespace {

using Kind = ScenarioFault::Kind;

constexpr std::array<SensorFaultKind, 6> sensor_kinds{SensorFaultKind::silent, SensorFaultKind::stuck,
                                                      SensorFaultKind::offset, SensorFaultKind::noise,
                                                      SensorFaultKind::jump,   SensorFaultKind::not_finite};
constexpr std::array<ActuatorFaultKind, 9> drive_kinds{
    ActuatorFaultKind::dead,     ActuatorFaultKind::weak, ActuatorFaultKind::stuck,
    ActuatorFaultKind::offset,   ActuatorFaultKind::late, ActuatorFaultKind::tripped,
    ActuatorFaultKind::disabled, ActuatorFaultKind::hot,  ActuatorFaultKind::old};

std::int64_t in_ns(double time_s) {
  return std::isfinite(time_s) ? std::llround(time_s * 1e9) : std::numeric_limits<std::int64_t>::max();
}

class PlantFaults {
 public:
  PlantFaults(const PlantVariant& variant, FaultyPlant& plant, Problems& problems)
      : variant_(variant),
        plant_(plant),
        problems_(problems),
        joints_(variant.model.joint_names()),
        drives_(variant.model.drive_names()) {}

  void add(const ScenarioFault& fault) {
    if (fault.of_sensor()) add_sensor(fault);
    if (fault.of_drive()) add_drive(fault);
    if (fault.of_supply()) {
      plant_.add(SupplyFault{.button = fault.kind == Kind::emergency_button,
                             .supply_V = fault.size,
                             .from_ns = in_ns(fault.from_s),
                             .until_ns = in_ns(fault.until_s)});
    }
  }

  void delay_all(double ticks) {
    for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
      plant_.add(ActuatorFault{.kind = ActuatorFaultKind::late, .joint = joint, .size = ticks});
    }
  }

 private:
  void add_drive(const ScenarioFault& fault) {
    const auto drive = std::ranges::find(drives_, fault.of.name);
    if (drive == drives_.end()) return problems_.add_unknown(fault.of.place, "drive", fault.of.name, drives_);
    plant_.add(ActuatorFault{
        .kind = drive_kinds.at(static_cast<std::size_t>(fault.kind) - static_cast<std::size_t>(Kind::drive_dead)),
        .joint = static_cast<std::size_t>(drive - drives_.begin()),
        .from_ns = in_ns(fault.from_s),
        .until_ns = in_ns(fault.until_s),
        .size = fault.size});
  }

  void add_sensor(const ScenarioFault& fault) {
    SensorFault planned{.kind = sensor_kinds.at(static_cast<std::size_t>(fault.kind)),
                        .from_ns = in_ns(fault.from_s),
                        .until_ns = in_ns(fault.until_s),
                        .size = fault.size};
    if (!find_place(fault.of, planned)) return;
    plant_.add(planned);
  }

  bool find_place(const PlacedName& of, SensorFault& planned) {
    const auto joint = std::ranges::find(joints_, of.name);
    const auto& feet = variant_.plant.feet;
    const auto foot = std::ranges::find(feet, of.name, &FootSettings::link);
    const auto& channels = variant_.plant.channels;
    const auto channel = std::ranges::find(channels, of.name, &SensorChannel::name);
    if (of.name == "imu") {
      planned.place = SensorKind::imu;
    } else if (joint != joints_.end()) {
      planned.index = static_cast<std::size_t>(joint - joints_.begin());
    } else if (foot != feet.end()) {
      planned.place = SensorKind::foot;
      planned.index = static_cast<std::size_t>(foot - feet.begin());
    } else if (channel != channels.end()) {
      planned.place = SensorKind::channel;
      planned.index = static_cast<std::size_t>(channel - channels.begin());
    } else {
      std::vector<std::string> known = joints_;
      for (const SensorChannel& each : channels) known.push_back(each.name);
      known.emplace_back("imu");
      for (const FootSettings& each : feet) known.push_back(each.link);
      problems_.add_unknown(of.place, "sensor", of.name, known);
      return false;
    }
    return true;
  }

  const PlantVariant& variant_;
  FaultyPlant& plant_;
  Problems& problems_;
  std::vector<std::string> joints_, drives_;
};

}  // namespace

std::unique_ptr<FaultyPlant> make_faulty_plant(const ScenarioConfig& scenario, const PlantVariant& variant,
                                               const EngineSettings& engine, std::uint64_t seed, World& world,
                                               std::size_t robot) {
  const double late_ticks = std::round(variant.actuation_delay_s / engine.control_period_s);
  const auto of_plant = [](const ScenarioFault& fault) {
    return fault.of_sensor() || fault.of_drive() || fault.of_supply();
  };
  if (late_ticks == 0 && std::ranges::none_of(scenario.faults, of_plant)) return nullptr;
  auto faulty = std::make_unique<FaultyPlant>(world, seed, robot, variant.model.transmissions);
  Problems problems(scenario.file);
  PlantFaults faults(variant, *faulty, problems);
  if (late_ticks > 0) faults.delay_all(late_ticks);
  for (const ScenarioFault& fault : scenario.faults) faults.add(fault);
  problems.throw_if_any();
  return faulty;
}

std::unique_ptr<FaultyHost> make_faulty_host(const ScenarioConfig& scenario, BehaviorHost& host) {
  std::unique_ptr<FaultyHost> faulty;
  for (const ScenarioFault& fault : scenario.faults) {
    FaultyHost::Fault planned{.from_ns = in_ns(fault.from_s), .until_ns = in_ns(fault.until_s)};
    switch (fault.kind) {
      case Kind::commands_lost:
        planned.kind = FaultyHost::Kind::lost;
        break;
      case Kind::commands_late:
        planned.kind = FaultyHost::Kind::late;
        planned.ticks = static_cast<std::size_t>(fault.size);
        break;
      case Kind::commands_not_finite:
        planned.kind = FaultyHost::Kind::not_finite;
        break;
      default:
        continue;
    }
    if (!faulty) faulty = std::make_unique<FaultyHost>(host);
    faulty->add(planned);
  }
  return faulty;
}

}  // namespace kadans
