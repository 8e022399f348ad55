// A scenario in one JSON file: robots, a plant, the behaviors that play, what happens, and the checks that must hold.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "config/json/fields.h"
#include "config/robot/input_event.h"
#include "config/robot/supervisor_config.h"
#include "distribution.h"
#include "kadans/signal/frames.h"
#include "play_item.h"
#include "scenario_check.h"
#include "world_config.h"

namespace kadans {

// What happens in a scenario at given times, so that the run can be repeated: orders of the supervisor, faults, pushes
// and what a person carries.

// An order of the supervisor at a given time. A reload lets a behavior continue with another file, as if somebody had
// saved it.
struct ScenarioEvent {
  double at_s = 0;
  PlayOrder order;
};

// The fields of one event. `folders` are used to find the behaviors of a list. The name of a reload's behavior is not
// checked here, because the names are known only when the behaviors play.
void event_fields(Fields& f, ScenarioEvent& event, const PlayFolders& folders);

// A fault that a scenario injects: in a sensor, a drive, the supply, the behaviors' tick, the transport of commands, or
// the clock.
struct ScenarioFault {
  enum class Kind : std::uint8_t {
    sensor_silent,
    sensor_stuck,
    sensor_offset,
    sensor_noise,
    sensor_jump,
    sensor_not_finite,
    drive_dead,
    drive_weak,
    drive_stuck,
    drive_offset,
    drive_late,
    drive_tripped,
    drive_disabled,
    drive_hot,
    drive_old,
    supply,
    emergency_button,
    behaviors_silent,
    commands_lost,
    commands_late,
    commands_not_finite,
    clock_missed,
    supervisor_silent,
  };
  Kind kind = Kind::sensor_silent;
  // For a drive fault the name of a drive, as plant.drives has it; for a sensor fault that of a joint, a foot's link or
  // a sensor, or "imu"; "" for faults of the whole robot.
  PlacedName of;
  double from_s = 0;
  double until_s = std::numeric_limits<double>::infinity();  // not included
  double size = 0;                                           // see the fields' docs
};
constexpr bool of_sensor(ScenarioFault::Kind kind) noexcept { return kind <= ScenarioFault::Kind::sensor_not_finite; }
constexpr bool of_drive(ScenarioFault::Kind kind) noexcept {
  return kind >= ScenarioFault::Kind::drive_dead && kind <= ScenarioFault::Kind::drive_old;
}
constexpr bool of_supply(ScenarioFault::Kind kind) noexcept {
  return kind == ScenarioFault::Kind::supply || kind == ScenarioFault::Kind::emergency_button;
}
constexpr bool of_commands(ScenarioFault::Kind kind) noexcept {
  return kind >= ScenarioFault::Kind::commands_lost && kind <= ScenarioFault::Kind::commands_not_finite;
}

void fault_fields(Fields& f, ScenarioFault& fault);

// A push on a link of the robot: a force that acts for a time.
inline constexpr double push_max_Ns = 1e4;  // along each axis

struct ScenarioPush {
  enum class Shape : std::uint8_t { constant, half_sine };
  PlacedName link;
  double at_s = 0;
  double duration_s = 0.1;
  Vec3 impulse_Ns{};  // world axes; the integral of the force
  Vec3 point_m{};     // in the link's frame
  Shape shape = Shape::constant;
};

// A robot is carried elsewhere: lifted as it stands, and put down at rest.
struct ScenarioCarry {
  double at_s = 0, heading_rad = 0;
  std::array<double, 2> to_m{};  // of the base
  TextPlace place{};             // of to_m
};

// The fields of one push, with "impulse_Ns" or "force_N" (its peak).
void push_fields(Fields& f, ScenarioPush& push);

// A scenario in one JSON file: a robot, a plant, the behaviors that play, and the checks that must hold.
inline constexpr double scenario_duration_max_s = 1e6;  // of simulated time
inline constexpr std::size_t further_robots_max = 7;

// A recording of a joystick that is played back.
struct ScenarioJoystick {
  std::string recording;  // "": none
  TextPlace place;
  double at_s = 0;
  double lost_at_s = std::numeric_limits<double>::infinity();  // the joystick is unplugged from then on
  std::vector<InputEvent> buttons{};                           // in place of the robot's for the same buttons
};

// Perception that is simulated (simulated_perception.h). The numbers are quantities, too.
struct SightSettings {
  double rate_Hz = 15;
  double latency_s = 0.1;
  double distance_noise = 0.05;  // standard deviation, per distance
  double bearing_noise_rad = 0.02;
  double missed = 0.1;  // share of the pictures
  double view_rad = 2;  // opening angle, about straight ahead
  double far_m = 6;
};
struct SightRange {
  const char* name;
  double SightSettings::*value;
  double min, max;
  const char* unit;
  const char* doc;
};
inline constexpr std::array<SightRange, 7> sight_ranges{
    {{"rate_Hz", &SightSettings::rate_Hz, 0.1, 100, "Hz", "pictures in a second"},
     {"latency_s", &SightSettings::latency_s, 0, 1, "s", "from a picture to what it says"},
     {"distance_noise", &SightSettings::distance_noise, 0, 1, "", "standard deviation of a distance, per distance"},
     {"bearing_noise_rad", &SightSettings::bearing_noise_rad, 0, 1, "rad", "standard deviation of a direction"},
     {"missed", &SightSettings::missed, 0, 1, "", "share of the pictures that miss the ball"},
     {"view_rad", &SightSettings::view_rad, 0, 6.3, "rad", "opening angle of the field of view, about straight ahead"},
     {"far_m", &SightSettings::far_m, 0.1, 100, "m", "the furthest that it sees"}}};

struct ScenarioSight {
  PlacedName ball;  // an object of the world; "": nothing is seen
  SightSettings settings;
};

// Perception of an entry of the world model: simulated (simulated_perception.h), or as it was in a recorded run
// (recorded_perception.h). The numbers of a simulated one are quantities, too.
struct ScenarioPerception {
  PlacedName entry;   // of the robot's supervisor
  PlacedName object;  // of the world; "": it comes from a record
  PlacedName record;  // a record, or a sequence of `kadans log observations`; "": it is simulated
  double from_s = 0;  // time in the record at which the scenario begins
  SightSettings settings;
  double imagined = 0;  // share of the pictures that show it where it is not
  bool hidden = false;  // other objects of the world may stand before it
};

// The network between the robots of a scenario.
struct ScenarioNetwork {
  double delay_s = 0.01, jitter_s = 0.01;
  double lost = 0;  // share of the messages
};

// Which plug-ins the robot may load. Plug-ins that a record from elsewhere names are not trusted.
struct PluginGate {
  bool closed = false;
  std::vector<std::filesystem::path> let_in;  // allowed although the gate is closed: absolute, normalised paths
  std::string remedy;                         // what a person can do to allow the others, for the message

  bool lets_in(const std::filesystem::path& file) const;
};

// A bus with drives that stands between the control and the model, on virtual time, and what befalls it.
struct ScenarioBus {
  PlacedName type;                 // a plant type with a wired world (plant_type.h); "": none
  std::vector<PlacedName> faults;  // "drive_hot:tilt@3=85", as of `kadans plant --fault`
};

struct ScenarioConfig {
  std::string file;
  std::string name;
  std::string doc;
  std::string record;             // repeated in place of a simulation, resolved; "": the scenario is simulated
  std::vector<std::string> with;  // with a record: files of the project that take the place of the record's, resolved
  std::string robot;              // path of the robot's configuration, resolved
  std::string plant = "bullet";   // name of a plant type (plant_type.h); a file may name only a model
  TextPlace plant_place;          // in a file that names one
  ScenarioBus bus;
  std::string imu;   // not in the file: the device of the IMU beside it; "": the one in the robot's configuration
  std::string peer;  // not in the file: address of a plant that is no model; "": the one in the robot's configuration
  bool read_only = false;  // not in the file: nothing is asked of the drives
  double duration_s = 0;
  std::uint64_t seed = 1;
  std::vector<std::string> tags;
  std::uint32_t repeat = 1;  // runs of it in `kadans test`, each with the next seed
  double wall_limit_s = 60;  // a run that takes longer is stopped
  PlacedName start_pose;     // "": the robot's own
  // Not in the file: where the robot starts, when it goes on from what was estimated; else no joints.
  struct {
    Quat orientation{1, 0, 0, 0};
    std::vector<double> position_rad;
  } placed{};
  std::vector<NumberEntry> set;  // values of quantities, by patterns over their names
  std::vector<Variation> randomise;
  std::vector<NumberEntry> set_last;  // not in the file: see set_last()
  std::vector<PlayItem> behaviors;
  std::vector<ScenarioEvent> events;
  std::vector<ScenarioPush> pushes;
  std::vector<ScenarioCarry> carried;
  std::vector<ScenarioFault> faults;
  WorldConfig world;
  ScenarioJoystick joystick;
  ScenarioSight sight;
  SupervisorConfig supervisor;  // in place of the robot's, when it is given
  std::vector<ScenarioPerception> perception;
  ScenarioNetwork network;
  std::string joystick_device;  // not in the file: device of a run on the wall clock
  bool repeats = false;         // a record stands for the plant, which is not driven
  bool undecided = false;       // not in the file: the robot's decisions do not run
  bool on_wall_clock = false;   // not in the file: time goes on while a behavior is slow
  std::vector<ScenarioCheck> checks;
  // Further robots in the same world and time. Of each only name, robot, quantities, behaviors, events, pushes,
  // faults and where it is carried are its own; plant_place is that of its name.
  std::vector<ScenarioConfig> robots;
  std::string robot_name;  // of the first robot, for viewers; "": as its configuration has it
  PluginGate plugins;      // not in the file
};

// A value that the command line sets, after all random draws, in place of what the file says or draws: of the further
// robot whose name it begins with ("left.joint.*.torque_scale"), else of the first one and the world.
void set_last(ScenarioConfig& scenario, NumberEntry entry);

// The folders in which the names of its behaviors are looked up.
PlayFolders folders_of(const ScenarioConfig& scenario);

// Throws InputError with all mistakes. The files that the scenario names exist, but they are not read yet. Signals are
// not checked here: code that has the signal table does so with refuse_unknown(file, {check.signal,
// check.signal_place}, "signal", ...). When the robot names plug-ins, an unknown plant is not refused here: the code
// that loads the plug-ins checks it. A scenario that repeats a record is refused: read_tested_scenario takes it, too.
ScenarioConfig read_scenario_config(const std::filesystem::path& file);
ScenarioConfig read_tested_scenario(const std::filesystem::path& file);
ScenarioConfig read_scenario_config_text(const std::string& text, const std::string& file);

// The fields of the file, for the schema.
FieldInfo describe_scenario_config();

}  // namespace kadans
