#include "planned_faults.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kadans {
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
      : variant_(variant), plant_(plant), problems_(problems), joints_(variant.model.joint_names()) {}

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
    const auto joint = std::ranges::find(joints_, fault.of.name);
    if (joint == joints_.end()) return problems_.add_unknown(fault.of.place, "joint", fault.of.name, joints_);
    plant_.add(ActuatorFault{
        .kind = drive_kinds.at(static_cast<std::size_t>(fault.kind) - static_cast<std::size_t>(Kind::drive_dead)),
        .joint = static_cast<std::size_t>(joint - joints_.begin()),
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
  std::vector<std::string> joints_;
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
  auto faulty = std::make_unique<FaultyPlant>(world, seed, robot);
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
