
#include "planned_faults.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace kadans {
namespace {

using Kind = ScenarioFault::Kind;

// The one value of a sensor that an error of some size is added to.
double& value_of(const PlannedFault& fault, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::imu) return frame.imu.angular_velocity_rad_s[0];
  if (fault.place == SensorKind::channel) return frame.channels[fault.index].value;
  return fault.place == SensorKind::foot ? frame.feet[fault.index].force_N[0] : frame.joints[fault.index].position_rad;
}

// All that the sensor says is as it was in `from`, but for the sequence numbers.
void repeat(const PlannedFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index].position_rad = from.joints[fault.index].position_rad;
  if (fault.place == SensorKind::foot) frame.feet[fault.index].force_N = from.feet[fault.index].force_N;
  if (fault.place == SensorKind::channel) frame.channels[fault.index].value = from.channels[fault.index].value;
  if (fault.place != SensorKind::imu) return;
  frame.imu.angular_velocity_rad_s = from.imu.angular_velocity_rad_s;
  frame.imu.acceleration_m_s2 = from.imu.acceleration_m_s2;
}

void silence(const PlannedFault& fault, const SensorFrame& from, SensorFrame& frame) noexcept {
  if (fault.place == SensorKind::joint) frame.joints[fault.index] = from.joints[fault.index];
  if (fault.place == SensorKind::foot) frame.feet[fault.index] = from.feet[fault.index];
  if (fault.place == SensorKind::channel) frame.channels[fault.index] = from.channels[fault.index];
  if (fault.place == SensorKind::imu) frame.imu = from.imu;
}

// What a drive that fails says of itself.
void tell(const PlannedFault& fault, std::int64_t time_ns, JointSample& sample) noexcept {
  switch (fault.kind) {
    case Kind::drive_tripped:
      sample.drive = DriveState::fault;
      sample.code = static_cast<std::uint32_t>(fault.size);
      break;
    case Kind::drive_disabled:
      sample.drive = DriveState::ready;
      break;
    case Kind::drive_hot:
      sample.temperature_C = static_cast<float>(fault.size);
      break;
    case Kind::drive_old:
      sample.time_ns = time_ns - static_cast<std::int64_t>(1e9 * fault.size);
      break;
    default:
      break;
  }
}

}  // namespace

FaultyPlant::FaultyPlant(World& world, std::uint64_t seed, std::size_t robot,
                         std::span<const Transmission> transmissions)
    : WorldAround(world, robot), random_(seed, "sensor faults") {
  std::ranges::copy_if(transmissions, std::back_inserter(couplings_), &Transmission::coupled);
}

void FaultyPlant::read(SensorFrame& sensors) noexcept {
  const SensorFrame before = sensors;  // a silent sensor repeats what it said last, sequence number included
  robot_.read(sensors);
  time_ns_ = sensors.time_ns;
  for (OfSensor& planned : sensor_faults_) {
    const PlannedFault& fault = planned.fault;
    if (!fault.is_now(time_ns_)) continue;
    if (!planned.begun) planned.first = fault.kind == Kind::sensor_silent ? before : sensors;
    spoil(planned, sensors);
    planned.begun = true;
  }
  for (const OfDrive& planned : drive_faults_) {
    if (planned.is_now(time_ns_)) tell(planned.fault, time_ns_, sensors.joints[planned.fault.index]);
  }
  for (const PlannedFault& fault : supply_faults_) {
    if (!fault.is_now(time_ns_)) continue;
    if (fault.kind == Kind::emergency_button) sensors.emergency = true;
    if (fault.kind == Kind::supply) sensors.supply_V = fault.size;
  }
}

void FaultyPlant::spoil(OfSensor& planned, SensorFrame& sensors) noexcept {
  const PlannedFault& fault = planned.fault;
  double& value = value_of(fault, sensors);
  switch (fault.kind) {
    case Kind::sensor_silent:
      silence(fault, planned.first, sensors);
      break;
    case Kind::sensor_stuck:
      repeat(fault, planned.first, sensors);
      break;
    case Kind::sensor_offset:
      value += fault.size;
      break;
    case Kind::sensor_noise: {
      const double draw = random_.uniform(-1, 1);
      value += fault.size * (draw < 0 ? 0.5 * draw - 0.5 : 0.5 * draw + 0.5);
      break;
    }
    case Kind::sensor_jump:
      if (!planned.begun) value += fault.size;
      break;
    case Kind::sensor_not_finite:
      value = std::numeric_limits<double>::quiet_NaN();
      break;
    default:
      break;
  }
}

// A drive that has tripped is reset, then enabled.
void FaultyPlant::OfDrive::heed(const DriveRequest& request, std::int64_t time_ns) noexcept {
  if (!request.is_new(order_seen) || !is_now(time_ns)) return;
  if (fault.kind == Kind::drive_disabled && request.order == DriveOrder::enable) over = true;
  if (fault.kind == Kind::drive_tripped && request.order == DriveOrder::reset) fault.kind = Kind::drive_disabled;
}

void FaultyPlant::add(const PlannedFault& fault) {
  if (of_sensor(fault.kind)) return sensor_faults_.push_back({.fault = fault, .first = {}});
  if (of_supply(fault.kind)) return supply_faults_.push_back(fault);
  if (!of_drive(fault.kind)) throw std::invalid_argument("a plant has no fault of this kind");
  if (fault.kind == Kind::drive_late && written_.empty()) written_.resize(late_ticks_max + 1);
  drive_faults_.push_back({.fault = fault, .held = {}, .order_seen = asked_[fault.index].number});
}

std::size_t FaultyPlant::late_ticks(const PlannedFault& fault) noexcept {
  return static_cast<std::size_t>(std::clamp(fault.size, 0.0, double{late_ticks_max}));
}

void FaultyPlant::spoil(OfDrive& planned, JointActuation& actuation) const noexcept {
  const PlannedFault& fault = planned.fault;
  if (!planned.is_now(time_ns_)) {
    planned.held = actuation;
    return;
  }
  switch (fault.kind) {
    case Kind::drive_dead:
    case Kind::drive_tripped:
    case Kind::drive_disabled:
      actuation = {};
      break;
    case Kind::drive_weak:
      actuation.effort_Nm *= fault.size;
      break;
    case Kind::drive_stuck:
      actuation = planned.held;
      break;
    case Kind::drive_offset:
      actuation.effort_Nm += fault.size;
      break;
    case Kind::drive_late:
      actuation = written_before(late_ticks(fault)).joints[fault.index];
      break;
    default:
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
  for (OfDrive& planned : drive_faults_) {
    planned.heed(actuation.drives[planned.fault.index], time_ns_);
    spoil(planned, spoiled.joints[planned.fault.index]);
  }
  asked_ = actuation.drives;
  robot_.write_drives(spoiled);
}

void FaultyPlant::hash(StateHash& hash) const noexcept {
  world_.hash(hash);
  for (const OfDrive& planned : drive_faults_) hash.add(planned.held.effort_Nm);
}

void FaultyPlant::hash_held_back(StateHash& hash) const noexcept {
  const auto add = [&hash](const JointActuation& actuation) {
    hash.add(static_cast<std::uint8_t>(actuation.mode));
    for (const double value : {actuation.position_rad, actuation.velocity_rad_s, actuation.effort_Nm}) hash.add(value);
  };
  for (const OfDrive& planned : drive_faults_) {
    add(planned.held);
    hash.add(static_cast<std::uint8_t>(static_cast<int>(planned.fault.kind) - static_cast<int>(Kind::drive_dead)));
    hash.add(planned.over);
    if (planned.fault.kind != Kind::drive_late) continue;
    for (std::size_t age = 0; age < late_ticks(planned.fault); ++age)
      add(written_before(age).joints[planned.fault.index]);
  }
}

void FaultyHost::add(const PlannedFault& fault) {
  if (!of_commands(fault.kind)) throw std::invalid_argument("commands have no fault of this kind");
  faults_.push_back(fault);
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
  for (const PlannedFault& fault : faults_) {
    if (!fault.is_now(time_ns)) continue;
    for (std::size_t i = before; i < under_way_.size(); ++i) {
      Batch& batch = under_way_[i];
      if (fault.kind == Kind::commands_late) batch.due_tick += static_cast<std::size_t>(fault.size);
      if (fault.kind == Kind::commands_lost) batch.commands.clear();
      if (fault.kind != Kind::commands_not_finite) continue;
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

std::int64_t in_ns(double time_s) {
  return std::isfinite(time_s) ? std::llround(time_s * 1e9) : std::numeric_limits<std::int64_t>::max();
}

PlannedFault planned_fault(const ScenarioFault& fault) {
  return {.kind = fault.kind, .from_ns = in_ns(fault.from_s), .until_ns = in_ns(fault.until_s), .size = fault.size};
}

// These find where a fault is. False, and there is a problem, when the robot has no such drive or sensor.
bool find_drive(const PlacedName& of, const RobotModel& model, PlannedFault& planned, Problems& problems) {
  const std::vector<std::string> drives = model.drive_names();
  const auto drive = std::ranges::find(drives, of.name);
  if (drive == drives.end()) return problems.add_unknown(of.place, "drive", of.name, drives), false;
  planned.index = static_cast<std::size_t>(drive - drives.begin());
  return true;
}

bool find_sensor(const PlacedName& of, const PlantVariant& variant, PlannedFault& planned, Problems& problems) {
  const std::vector<std::string> joints = variant.model.joint_names();
  const auto joint = std::ranges::find(joints, of.name);
  const auto& feet = variant.plant.feet;
  const auto foot = std::ranges::find(feet, of.name, &FootSettings::link);
  const auto& channels = variant.plant.channels;
  const auto channel = std::ranges::find(channels, of.name, &SensorChannel::name);
  if (of.name == "imu") {
    planned.place = SensorKind::imu;
  } else if (joint != joints.end()) {
    planned.index = static_cast<std::size_t>(joint - joints.begin());
  } else if (foot != feet.end()) {
    planned.place = SensorKind::foot;
    planned.index = static_cast<std::size_t>(foot - feet.begin());
  } else if (channel != channels.end()) {
    planned.place = SensorKind::channel;
    planned.index = static_cast<std::size_t>(channel - channels.begin());
  } else {
    std::vector<std::string> known = joints;
    for (const SensorChannel& each : channels) known.push_back(each.name);
    known.emplace_back("imu");
    for (const FootSettings& each : feet) known.push_back(each.link);
    problems.add_unknown(of.place, "sensor", of.name, known);
    return false;
  }
  return true;
}

}  // namespace

std::unique_ptr<FaultyPlant> make_faulty_plant(const ScenarioConfig& scenario, const PlantVariant& variant,
                                               const EngineSettings& engine, std::uint64_t seed, World& world,
                                               std::size_t robot) {
  const double late_ticks = std::round(variant.actuation_delay_s / engine.control_period_s);
  const auto of_plant = [](const ScenarioFault& fault) {
    return of_sensor(fault.kind) || of_drive(fault.kind) || of_supply(fault.kind);
  };
  if (late_ticks == 0 && std::ranges::none_of(scenario.faults, of_plant)) return nullptr;
  auto faulty = std::make_unique<FaultyPlant>(world, seed, robot, variant.model.transmissions);
  for (std::size_t joint = 0; late_ticks > 0 && joint < variant.model.joints.size(); ++joint)
    faulty->add({.kind = Kind::drive_late, .index = joint, .size = late_ticks});
  Problems problems(scenario.file);
  for (const ScenarioFault& fault : scenario.faults) {
    PlannedFault planned = planned_fault(fault);
    const bool found = of_sensor(fault.kind)  ? find_sensor(fault.of, variant, planned, problems)
                       : of_drive(fault.kind) ? find_drive(fault.of, variant.model, planned, problems)
                                              : of_supply(fault.kind);
    if (found) faulty->add(planned);
  }
  problems.throw_if_any();
  return faulty;
}

std::unique_ptr<FaultyHost> make_faulty_host(const ScenarioConfig& scenario, BehaviorHost& host) {
  std::unique_ptr<FaultyHost> faulty;
  for (const ScenarioFault& fault : scenario.faults) {
    if (!of_commands(fault.kind)) continue;
    if (!faulty) faulty = std::make_unique<FaultyHost>(host);
    faulty->add(planned_fault(fault));
  }
  return faulty;
}

}  // namespace kadans
