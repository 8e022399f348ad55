#include "assembled_plant.h"

#include <algorithm>
#include <stdexcept>

#include "kadans/plant/emulated_drives.h"
#include "plant/imu/emulator/imu_world.h"
#include "plant/imu/imu_plant.h"

namespace kadans {
namespace {

// Stands for a plant in a run that repeats a record: it has its signals, and its sensors are those of the record.
// Nothing hears its actuation, unless the run goes on in a model.
class FedPlant final : public Plant {
 public:
  FedPlant(std::unique_ptr<Plant> plant, PlantExchange& record) : plant_(std::move(plant)), record_(record) {}

  void declare_signals(SignalTable& table) const override { plant_->declare_signals(table); }
  void read(SensorFrame& sensors) noexcept override {
    const auto newest = record_.sensors.read();
    copy_used(*newest, sensors);
  }
  void write(const ActuationFrame& actuation) noexcept override { record_.actuation.publish(actuation); }

 private:
  std::unique_ptr<Plant> plant_;  // never open
  PlantExchange& record_;
};

// A plant that is only read: whatever the engine asks, its drives are asked for nothing, and no order reaches them.
//
// Control thread in the tick; the rest as of the plant behind it.
class ReadOnlyPlant final : public Plant {
 public:
  explicit ReadOnlyPlant(Plant& plant) : plant_(plant) {}  // keeps a reference

  void declare_signals(SignalTable& table) const override { plant_.declare_signals(table); }
  bool open(bool (*give_up)() noexcept) override { return plant_.open(give_up); }
  void close() noexcept override { plant_.close(); }
  std::vector<PlantCount> link_counts() const override { return plant_.link_counts(); }
  void read(SensorFrame& sensors) noexcept override { plant_.read(sensors); }
  void write(const ActuationFrame& actuation) noexcept override {
    nothing_.joint_count = actuation.joint_count;
    plant_.write(nothing_);
  }

 private:
  Plant& plant_;
  ActuationFrame nothing_;
};

}  // namespace

PlantVariant plant_variant(const ScenarioConfig& scenario, const RobotConfig& robot) {
  PlantVariant variant{.model = robot.model, .plant = robot.plant};
  variant.plant.world = world_for(scenario.world, robot.model, scenario.file);
  variant.sees = !scenario.sight.ball.name.empty();
  variant.sight = scenario.sight.settings;
  variant.perception = scenario.perception;
  return variant;
}

const PlantType& plant_type_named(const RobotConfig& robot, const std::string& file, const PlacedName& name,
                                  bool (PlantType::*is)() const noexcept) {
  const std::vector<std::string> names = plant_type_names(robot.plant_types, is);
  if (std::ranges::find(names, name.name) == names.end()) refuse_unknown(file, name, "type of plant", names);
  return kadans::plant_type(robot.plant_types, name.name);
}

PlantSite plant_site(const RobotConfig& robot, const std::string& peer) {
  PlantSite site{.file = robot.file,
                 .layout = {.robot = robot.name,
                            .joints = robot.model.joint_names(),
                            .feet = {},
                            .sensors = {},
                            .period_ns = robot.engine.control_period_ns()},
                 .peer = peer,
                 .damping_Nms_per_rad = robot.safety.damping_Nms_per_rad,
                 .transmissions = robot.model.transmissions};
  for (const FootSettings& foot : robot.plant.feet) site.layout.feet.push_back(foot.link);
  for (const SensorChannel& sensor : robot.plant.channels) site.layout.sensors.push_back(sensor.name);
  return site;
}

std::unique_ptr<Plant> make_bus(const RobotConfig& robot, const PlantType& type, const std::string& peer,
                                const std::string& imu) {
  std::unique_ptr<Plant> plant = type.make_plant(plant_site(robot, peer));
  imu::SerialImuSettings beside = serial_imu_at(robot, type, "--imu", imu);
  if (!beside.given()) return plant;
  return std::make_unique<imu::ImuPlant>(std::move(plant), std::move(beside), robot.plant.imu.pose.orientation);
}

imu::SerialImuSettings serial_imu_at(const RobotConfig& robot, const PlantType& type, const char* option,
                                     const std::string& device) {
  imu::SerialImuSettings settings = robot.serial_imu;
  if (!settings.given() && !device.empty()) refuse(option, robot.file + " says no plant.serial_imu (docs/imu.md)");
  if (!device.empty()) {
    settings.device = device;
    settings.place = {.file = option};
  }
  return type.has_imu() ? imu::SerialImuSettings() : settings;
}

void AssembledPlant::make(std::span<const WorldSite> robots) {
  const PlantType& chosen = type();
  if (!chosen.is_model()) {
    bus_ = make_bus(robot_, chosen, scenario_.peer, scenario_.imu);
    if (scenario_.repeats) bus_ = std::make_unique<FedPlant>(std::move(bus_), *link_);
  } else {
    sound_ = robots.size() > 1 ? chosen.make_shared_world(robots) : chosen.make_world(robots.front());
    if (has_bus()) stand_behind_bus();
    enter(*sound_);
    if (link_ != nullptr) linked_ = std::make_unique<LinkedPlant>(*link_, *world());
  }
  stand_before();
}

void AssembledPlant::join(AssembledPlant& first) {
  enter(*first.world_);
  stand_before();
}

void AssembledPlant::enter(World& world) {
  world_ = &world;
  faulty_ = make_faulty_plant(scenario_, variant_, robot_.engine, seed_, world, number_);
}

void AssembledPlant::stand_before() {
  if (scenario_.read_only) read_only_ = std::make_unique<ReadOnlyPlant>(plant());
  if (!in_lockstep()) last_word_ = std::make_unique<LastWord>(plant());
}

Plant& AssembledPlant::plant() noexcept {
  if (read_only_) return *read_only_;
  if (bus_) return *bus_;
  return linked_ ? static_cast<Plant&>(*linked_) : robot();
}

const TruthSource* AssembledPlant::truth_source() noexcept {
  return linked_ ? static_cast<const TruthSource*>(linked_.get()) : world_ == nullptr ? nullptr : &robot();
}

// A file names a model, the command line whatever drives.
const PlantType& AssembledPlant::type() const {
  const TextPlace place = scenario_.plant_place, world = scenario_.world.place;
  const PlantType& type = place.line > 0
                              ? plant_type_named(robot_, scenario_.file, {scenario_.plant, place}, &PlantType::is_model)
                              : plant_type_named(robot_, "--plant", {scenario_.plant, place});
  if (world.line > 0 && !type.has_objects())
    refuse(scenario_.file, world, "world: the plant " + scenario_.plant + " has none");
  if (!scenario_.robots.empty() && !type.has_objects())
    refuse(scenario_.file, scenario_.robots.front().plant_place, "robots: the plant " + scenario_.plant + " has one");
  return type;
}

const PlantType& AssembledPlant::bus_type() const {
  return plant_type_named(robot_, scenario_.file, scenario_.bus.type, &PlantType::has_wired_world);
}

// What befalls the IMU on its line is told to that, the rest to the bus.
void AssembledPlant::stand_behind_bus() {
  const PlantType& type = bus_type();
  const imu::SerialImuSettings beside = serial_imu_at(robot_, type, "", "");
  PlantSite site = plant_site(robot_, "");
  site.seed = seed_;
  std::vector<EmulatedFault> faults, faults_of_imu;
  for (const PlacedName& one : scenario_.bus.faults) {
    try {
      const EmulatedFault fault = emulated_fault(one.name);
      (beside.given() && fault.of == "imu" ? faults_of_imu : faults).push_back(fault);
    } catch (const std::invalid_argument& error) {
      refuse(scenario_.file, one.place, "bus.faults: " + one.name + ": " + error.what());
    }
  }
  try {
    sound_ = type.make_wired_world(std::move(sound_), site, faults);
    if (beside.given())
      sound_ = std::make_unique<imu::ImuWorld>(std::move(sound_), beside, robot_.plant.imu.pose.orientation,
                                               faults_of_imu, seed_);
  } catch (const std::invalid_argument& error) {
    refuse(scenario_.file, scenario_.bus.type.place, std::string("bus.faults: ") + error.what());
  }
  (void)sound_->robot(0).open();
}

}  // namespace kadans
