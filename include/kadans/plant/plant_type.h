// The types of plants that a robot can be driven through: a model in a simulated world, or a bus with drives.
//
// A type is a folder of src/plant with a file type.cpp; nothing else names it. Its fields stand under plant.NAME in the
// robot's configuration, `--plant NAME` chooses it, and schema and check know it by what it declares here. A program
// that links Kadans (app/program.h) registers types of its own before main():
//
//   KADANS_REGISTER_PLANT_TYPE(make_bench_type);  // std::unique_ptr<kadans::PlantType> make_bench_type();
//
// and a plug-in brings them to any program (kadans/control/plugin.h). docs/hardware.md says how to write one.
//
// Before the loop, one thread. The plants and emulators that a type makes state their threads themselves.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kadans/plant/settings.h"
#include "kadans/plant/world.h"
#include "kadans/signal/fault.h"
#include "kadans/signal/input_error.h"

namespace kadans {

// Visits a list of fields, to read or to describe them (src/config/json/fields.h). `doc` is a sentence for people.
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
  // Objects whose keys the file chooses: `read` lists the fields of one of them. It is also called, with "" as the key,
  // when the fields are only described.
  using ReadEntry = std::function<void(PlantFields& entry, const std::string& key)>;
  virtual void map(std::string_view name, const ReadEntry& read, std::string_view doc) = 0;

  // False while the fields are only described and there is no file.
  virtual bool reading() const noexcept = 0;
  // The names of the robot's drives, in the order of the joints; none while there is no robot.
  virtual std::span<const std::string> drives() const noexcept = 0;
  // A mistake that only the type can see: told with file, line and column of the field's value, or of this object's key
  // when the name is "" or the field is not given.
  virtual void refuse(std::string_view name, const std::string& why) = 0;
  // That place without a message, for a mistake that only the drives' answers show; without file while there is none.
  virtual InputProblem place(std::string_view name) const {
    (void)name;
    return {};
  }

 protected:
  ~PlantFields() = default;
};

// What both ends of a bus must agree on.
struct PlantLayout {
  std::string robot;
  std::vector<std::string> joints, feet, sensors;  // names, in the order of the frames
  std::int64_t period_ns = 1'000'000;
};

// The robot for which drives, or an emulator of drives, are made.
struct PlantSite {
  std::string file;  // the robot's configuration, for messages
  PlantLayout layout;
  std::string peer;                // where the drives are, from the command line; "": where the configuration says
  double damping_Nms_per_rad = 2;  // of joints that nobody drives
  std::uint64_t seed = 1;          // of what is random in an emulator
  std::vector<Transmission> transmissions{};  // frames speak of joints; what the drives speak of lies behind these
};

// What befalls an emulated bus or its drives, in the words of scenarios' faults where they have them.
struct EmulatedFault {
  std::string kind, of;              // "drive_hot", "tilt"
  double from_s = 0, until_s = 1e9;  // of the model's time in a session; it begins again with each
  double size = 0;                   // what the kind says
};

// The other side of a type's wire: programs that speak its protocol drive a modelled robot, one after the other.
//
// Threads: look() and await() before a session, beat() in it, the rest after it.
class PlantEmulator {
 public:
  struct Session {
    std::uint32_t releases = 0;      // how often the watchdog took over the joints
    std::int64_t answer_max_ns = 0;  // greatest age of the sample that an actuation answers, by the plant's clock
    double answer_sum_ns = 0;
    std::uint64_t answers = 0;
    bool left = false;  // the peer said goodbye; else it fell silent
    double answer_mean_ns() const noexcept { return answers == 0 ? 0 : answer_sum_ns / static_cast<double>(answers); }
  };

  virtual ~PlantEmulator() = default;
  PlantEmulator() = default;
  PlantEmulator(const PlantEmulator&) = delete;
  PlantEmulator& operator=(const PlantEmulator&) = delete;

  // What is said of the robot before the first beat is true of this world. Called before await() for each new world.
  virtual void look(World& world) { (void)world; }
  // Waits at most this long for datagrams and answers them. True once there is a peer: a session began.
  virtual bool await(int milliseconds) noexcept = 0;
  // `periods` passed since the last beat. False: the session is over. Throws what the world's step throws.
  virtual bool beat(World& world, std::uint32_t periods) = 0;
  // From now on the world's time passes with the peer's control ticks, not with the periods of beats, which only say
  // how much may pass at most. False: this protocol does not count the peer's ticks.
  virtual bool step_with_peer() noexcept { return false; }
  // Before the first session. Throws std::invalid_argument for what this bus or its drives cannot have.
  virtual void plan_faults(const std::vector<EmulatedFault>& faults);
  virtual std::string peer_name() const = 0;
  virtual const Session& session() const noexcept = 0;
  virtual std::vector<PlantCount> link_counts() const = 0;
};

// Where a type's configuration says how a drive is wired: names of fields under plant.TYPE.SECTION.DRIVE. What `kadans
// commission` finds out, it writes there. "": the type has no such field.
struct DriveWiringFields {
  std::string_view section;
  std::vector<std::string_view> both{};     // of what motor and encoder share
  std::vector<std::string_view> motor{};    // where the motor is wired to
  std::vector<std::string_view> encoder{};  // where the encoder is; none: motor and encoder are one device
  std::string_view motor_reversed{}, encoder_reversed{};
  std::string_view home{};                     // how the drive itself looks for its zero
  std::string_view zero{};                     // where the zero is ...
  double zero_default = 0, zero_unit_rad = 1;  // ... and what it counts
  double zero_turn = 0;                        // a zero in pulses of a turn wraps; 0: it does not
};
// The fields of one drive that say how strong it is, with their values.
struct DriveConstants {
  struct Field {
    std::string_view name{};  // "": there is none
    double value = 0;
  };
  Field scale{};                 // at rest the drive's torque is proportional to it
  Field stiffness{}, damping{};  // gains of its position mode where that is closed by the plant: Nm/rad, Nms/rad
};

// A type of plant, with the settings that one robot's configuration gives to it.
class PlantType {
 public:
  virtual ~PlantType() = default;
  PlantType() = default;
  PlantType(const PlantType&) = delete;
  PlantType& operator=(const PlantType&) = delete;

  virtual std::string_view name() const noexcept = 0;
  virtual std::string_view doc() const noexcept = 0;  // what it is, in a few words
  // The fields that the robot's configuration may set under the type's name. A field that it omits keeps its value.
  virtual bool has_fields() const noexcept { return false; }
  virtual void fields(PlantFields& fields) { (void)fields; }

  // A model: make_world makes a world of one robot. Throws std::invalid_argument that names the setting that does not
  // fit.
  virtual bool is_model() const noexcept { return false; }
  virtual bool has_objects() const noexcept { return false; }  // a scenario's "world" and "robots" can stand in it
  virtual std::unique_ptr<World> make_world(const WorldSite& site) const;
  // One that has objects: a world of several robots; the first one's settings are those of the world.
  virtual std::unique_ptr<World> make_shared_world(std::span<const WorldSite> sites) const;

  // Not a model: make_plant makes the plant that reaches the drives. It is not open yet. Throws InputError.
  virtual std::unique_ptr<Plant> make_plant(const PlantSite& site) const;

  // What helps or hinders these drives on this machine, for `kadans doctor ROBOT`: nothing is opened and nothing moves.
  // Without a configuration of the type there is nothing to say.
  struct Finding {
    std::string topic;
    bool good = false;
    std::string is, should, how;  // the last two say what to do where it is not good
  };
  virtual std::vector<Finding> examine(const PlantSite& site) const {
    (void)site;
    return {};
  }

  // nullptr: it has no wiring to find out.
  virtual const DriveWiringFields* wiring() const { return nullptr; }
  virtual DriveConstants constants_of(std::string_view drive) const {
    (void)drive;
    return {};
  }

  // The maker's words for the codes of its drives; nullptr: codes are told as numbers.
  virtual DriveWords drive_words() const noexcept { return nullptr; }

  // Its frames have an IMU: none on a serial line stands beside it.
  virtual bool has_imu() const noexcept { return false; }

  // Speaks a protocol: make_emulator makes the other side of it, which listens at `listen`. Throws InputError.
  virtual bool is_protocol() const noexcept { return false; }
  virtual std::unique_ptr<PlantEmulator> make_emulator(const PlantSite& site, const std::string& listen) const;

  // The same with both ends of the wire on virtual time: make_wired_world makes a world of one robot around `model`,
  // which is driven through the bus, byte by byte. Throws InputError; for faults that it cannot have
  // std::invalid_argument. Its robot's open() finds the drives.
  virtual bool has_wired_world() const noexcept { return false; }
  virtual std::unique_ptr<World> make_wired_world(std::unique_ptr<World> model, const PlantSite& site,
                                                  const std::vector<EmulatedFault>& faults) const;
};

using MakePlantType = std::unique_ptr<PlantType> (*)();
using PlantTypes = std::vector<std::shared_ptr<PlantType>>;

// The types of this program, each with its default settings: the shipped ones by name, then the registered ones, then
// those that `others` make, which plug-ins bring. Throws std::invalid_argument when two have the same name.
PlantTypes plant_types(std::span<const MakePlantType> others = {});
// The type of this name. Throws std::out_of_range when there is none.
const PlantType& plant_type(const PlantTypes& types, std::string_view name);

// Names of the types for which `is` holds; without `is`, of all: among the types of this program, or among `types`.
std::vector<std::string> plant_type_names(bool (PlantType::*is)() const noexcept = nullptr);
std::vector<std::string> plant_type_names(const PlantTypes& types, bool (PlantType::*is)() const noexcept = nullptr);

// An entry in the list of the types that were registered before main(). Only the macro makes one.
class RegisteredPlantType {
 public:
  explicit RegisteredPlantType(MakePlantType make) noexcept;
  // Adds the registered types, and behind them those that `others` make.
  static void add_all(PlantTypes& types, std::span<const MakePlantType> others = {});

 private:
  MakePlantType make_;
  RegisteredPlantType* next_;
};

}  // namespace kadans

// Write it at namespace scope in a source file of the program itself: from a static library the linker drops source
// files that nothing else refers to.
#define KADANS_REGISTER_PLANT_TYPE(make) KADANS_REGISTER_PLANT_TYPE_AT(make, __COUNTER__)
#define KADANS_REGISTER_PLANT_TYPE_AT(make, count) KADANS_REGISTER_PLANT_TYPE_AS(make, count)
#define KADANS_REGISTER_PLANT_TYPE_AS(make, count)                                \
  namespace {                                                                     \
  const ::kadans::RegisteredPlantType kadans_registered_plant_type_##count(make); \
  }                                                                               \
  static_assert(true) /* takes the semicolon */
