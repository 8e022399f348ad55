// What a robot of a run acts on: a world, in which further robots may be, or a bus; and what stands between that and
// its engine. Here alone the types of plants are chosen.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "app/run/last_word.h"
#include "config/robot/robot_config.h"
#include "config/scenario/scenario_config.h"
#include "kadans/plant/plant_type.h"
#include "kadans/plant/world.h"
#include "realtime/engine_tasks.h"
#include "scenario/disturb/planned_faults.h"
#include "scenario/disturb/quantities.h"

namespace kadans {

// The type of plant of this name for which `is` holds: a shipped one, one of this program, or one of the robot's
// plug-ins. Throws InputError that lists the known names.
const PlantType& plant_type_named(const RobotConfig& robot, const std::string& file, const PlacedName& name,
                                  bool (PlantType::*is)() const noexcept = nullptr);
// The data from which a plant that is no model is made. `peer` is its address; "": the one in the configuration.
PlantSite plant_site(const RobotConfig& robot, const std::string& peer);
// The robot's IMU beside a bus of this type, at the device that the command line names, else at the configuration's;
// not given() where it has none. Throws InputError.
imu::SerialImuSettings serial_imu_at(const RobotConfig& robot, const PlantType& type, const char* option,
                                     const std::string& device);
// What reaches the drives of this type, and the IMU beside them. It is not open yet. Throws InputError.
std::unique_ptr<Plant> make_bus(const RobotConfig& robot, const PlantType& type, const std::string& peer,
                                const std::string& imu);

// The plant as the files have it: no start pose, nothing set or drawn.
PlantVariant plant_variant(const ScenarioConfig& scenario, const RobotConfig& robot);

// In the way of the data, from the robot to its engine:
//   a world: the model, a bus that is emulated before it, planned faults, the link to the world's own thread;
//   or a bus, or a record in its place;
//   then what keeps the drives from being asked, and the last word.
class AssembledPlant {
 public:
  // Keeps references. `variant` is complete when the world is made. Robot 0 is the first, which makes the world of all.
  AssembledPlant(const ScenarioConfig& scenario, const RobotConfig& robot, const PlantVariant& variant,
                 std::uint64_t seed, std::size_t number, PlantExchange* link)
      : scenario_(scenario), robot_(robot), variant_(variant), seed_(seed), number_(number), link_(link) {}

  // The first robot's, with the sites of all robots. Throws InputError, and std::invalid_argument for a wrong model.
  void make(std::span<const WorldSite> robots);
  // A further robot's, whose site was among those.
  void join(AssembledPlant& first);

  Plant& plant() noexcept;                                                                    // not open yet
  Plant& seen() noexcept { return last_word_ ? static_cast<Plant&>(*last_word_) : plant(); }  // by the engine
  // Through which the engine sees the plant when it has a thread of its own; else nullptr.
  LastWord* last_word() noexcept { return last_word_.get(); }
  World* world() noexcept { return faulty_ ? faulty_.get() : world_; }  // with its faults; nullptr: there is none
  WorldRobot& robot() noexcept { return faulty_ ? *faulty_ : world_->robot(number_); }  // in that world
  const TruthSource* truth_source() noexcept;                                           // nullptr: there is none
  FaultyPlant* faulty() noexcept { return faulty_.get(); }                              // nullptr: no faults of it
  // The engine steps the world itself.
  bool in_lockstep() const noexcept { return world_ != nullptr && linked_ == nullptr; }
  DriveWords drive_words() const { return (has_bus() ? bus_type() : type()).drive_words(); }

 private:
  const PlantType& type() const;
  bool has_bus() const noexcept { return !scenario_.bus.type.name.empty(); }
  const PlantType& bus_type() const;
  void stand_behind_bus();
  void enter(World& world);
  void stand_before();

  const ScenarioConfig& scenario_;
  const RobotConfig& robot_;
  const PlantVariant& variant_;
  std::uint64_t seed_;
  std::size_t number_;  // in the world
  PlantExchange* link_;
  std::unique_ptr<World> sound_;         // of the first robot; the others are in it
  World* world_ = nullptr;               // the same
  std::unique_ptr<FaultyPlant> faulty_;  // wraps the robot when the scenario has faults of the plant
  std::unique_ptr<LinkedPlant> linked_;  // when the world is on another thread
  std::unique_ptr<Plant> bus_;           // when there is no world
  std::unique_ptr<Plant> read_only_;     // when the drives are asked for nothing
  std::unique_ptr<LastWord> last_word_;
};

}  // namespace kadans
