// The types of plants that a robot can be driven through: a model in a simulated world, or a bus with drives.
//
// A type is a folder of src/plant with a file type.cpp; nothing else names it. The robot's configuration reads its
// fields under plant.NAME, `--plant NAME` chooses it, schema and check know it by what it says of itself here. A
// program that links Kadans (app/program.h) registers types of its own before main():
//
//   KADANS_REGISTER_PLANT_TYPE(make_bench_type);  // std::unique_ptr<kadans::PlantType> make_bench_type();
//
// and a plug-in brings them to any program (kadans/control/plugin.h). docs/hardware.md says how one is written.
//
// Before the loop, one thread, but for what the made plants and emulators say of themselves.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/plant/settings.h"
#include "kadans/plant/world.h"
#include "kadans/signal/fault.h"

namespace kadans {

// What a list of fields is read into, or described to: see config/fields.h. `doc` is a sentence for people.
class PlantFields {
 public:
  struct Range {
    double min, max;
    std::string_view unit;
  };
  virtual void number(std::string_view name, double& value, Range range, std::string_view doc) = 0;
  virtual void integer(std::string_view name, std::uint32_t& value, Range range, std::string_view doc) = 0;
  virtual void boolean(std::string_view name, bool& value, std::string_view doc) = 0;
  virtual void string(std::string_view name, std::string& value, std::string_view doc) = 0;

 protected:
  ~PlantFields() = default;
};

// What both ends of a bus must agree on.
struct PlantLayout {
  std::string robot;
  std::vector<std::string> joints, feet, sensors;  // names, in the order of the frames
  std::int64_t period_ns = 1'000'000;
};

// The robot that drives, or an emulator of them, are made for.
struct PlantSite {
  std::string file;  // the robot's configuration, for messages
  PlantLayout layout;
  std::string peer;                // where the drives are, by the command line; "": where the configuration says
  double damping_Nms_per_rad = 2;  // of joints that nobody drives
};

// The robot that a world is made for. `seed` feeds every noise.
struct WorldSite {
  const RobotModel& model;
  const PlantSettings& settings;
  std::uint64_t seed = 1;
};

// The other side of a type's wire: who speaks its protocol drives a modelled robot, one after the other.
//
// Threads: await() before a session, beat() in it, the rest after it.
class PlantEmulator {
 public:
  struct Session {
    std::uint32_t releases = 0;      // times that the watchdog took the joints
    std::int64_t answer_max_ns = 0;  // oldest sample that an actuation was told to answer, by the plant's clock
    double answer_sum_ns = 0;
    std::uint64_t answers = 0;
    bool left = false;  // the peer said goodbye; else it fell silent
    double answer_mean_ns() const noexcept { return answers == 0 ? 0 : answer_sum_ns / static_cast<double>(answers); }
  };

  virtual ~PlantEmulator() = default;
  PlantEmulator() = default;
  PlantEmulator(const PlantEmulator&) = delete;
  PlantEmulator& operator=(const PlantEmulator&) = delete;

  // Answers what came, after waiting for it for so long; true once there is a peer: a session began.
  virtual bool await(int milliseconds) noexcept = 0;
  // `periods` passed since the last beat. False: the session is over. Throws what the world's step throws.
  virtual bool beat(World& world, std::uint32_t periods) = 0;
  virtual std::string peer_name() const = 0;
  virtual const Session& session() const noexcept = 0;
  virtual std::vector<PlantCount> link_counts() const = 0;
};

// Holds the settings that one robot's configuration gives to it.
class PlantType {
 public:
  virtual ~PlantType() = default;
  PlantType() = default;
  PlantType(const PlantType&) = delete;
  PlantType& operator=(const PlantType&) = delete;

  virtual std::string_view name() const noexcept = 0;
  virtual std::string_view doc() const noexcept = 0;  // what it is, some words
  // What the robot's configuration may say under the type's name; what it does not say keeps its value.
  virtual bool has_fields() const noexcept { return false; }
  virtual void fields(PlantFields& fields) { (void)fields; }

  // A model: make_world makes it. Throws std::invalid_argument that names what in the settings does not fit.
  virtual bool is_model() const noexcept { return false; }
  virtual bool has_objects() const noexcept { return false; }  // a scenario's "world" can stand in it
  virtual std::unique_ptr<World> make_world(const WorldSite& site) const;

  // Not a model: make_plant makes what drives are reached through; not open yet. Throws InputError.
  virtual std::unique_ptr<Plant> make_plant(const PlantSite& site) const;

  // What the maker calls the codes that its drives tell; none: they are told as numbers.
  virtual DriveWords drive_words() const noexcept { return nullptr; }

  // Speaks a protocol: make_emulator serves a world to it, at the place where it listens. Throws InputError.
  virtual bool is_protocol() const noexcept { return false; }
  virtual std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const;
};

using MakePlantType = std::unique_ptr<PlantType> (*)();
using PlantTypes = std::vector<std::shared_ptr<PlantType>>;

// Those of this program, each with its default settings: the shipped ones by name, then those that were registered,
// then those that `others` make, which plug-ins bring. Throws std::invalid_argument when two have one name.
PlantTypes plant_types(std::span<const MakePlantType> others = {});
// One that is there. Throws std::out_of_range.
const PlantType& plant_type(const PlantTypes& types, std::string_view name);

// Names of the types for which `is` holds; of all. Those of this program, or among `types`.
std::vector<std::string> plant_type_names(bool (PlantType::*is)() const noexcept = nullptr);
std::vector<std::string> plant_type_names(const PlantTypes& types, bool (PlantType::*is)() const noexcept = nullptr);

// One link in the list of what was registered before main(); never made but by the macro.
class RegisteredPlantType {
 public:
  explicit RegisteredPlantType(MakePlantType make) noexcept;
  // And behind them what `others` make.
  static void add_all(PlantTypes& types, std::span<const MakePlantType> others = {});

 private:
  MakePlantType make_;
  RegisteredPlantType* next_;
};

}  // namespace kadans

// At namespace scope in a source file of the program itself: the linker drops those of a static library that nothing
// else refers to.
#define KADANS_REGISTER_PLANT_TYPE(make) KADANS_REGISTER_PLANT_TYPE_AT(make, __COUNTER__)
#define KADANS_REGISTER_PLANT_TYPE_AT(make, count) KADANS_REGISTER_PLANT_TYPE_AS(make, count)
#define KADANS_REGISTER_PLANT_TYPE_AS(make, count)                                \
  namespace {                                                                     \
  const ::kadans::RegisteredPlantType kadans_registered_plant_type_##count(make); \
  }                                                                               \
  static_assert(true) /* takes the semicolon */
