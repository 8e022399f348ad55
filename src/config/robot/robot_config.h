// A robot's configuration: one JSON file that names the robot's URDF and sets everything else of plant, estimator,
// safety, engine, control objects, control sets and poses. The keys are the names of the structs' fields, units
// included. For settings of joints the key is a pattern over the joints' names ("*_knee"); later entries override
// earlier ones.
//
// This code knows no concrete control object. The caller gives the names of the types, and apply_parameters checks the
// parameters against the objects' own tables.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "config/json/fields.h"
#include "engine/settings.h"
#include "estimate/settings.h"
#include "input_event.h"
#include "kadans/control/catalog.h"
#include "kadans/model/robot_model.h"
#include "kadans/plant/plant_type.h"
#include "kadans/plant/settings.h"
#include "kadans/signal/input_error.h"
#include "plant/imu/settings.h"
#include "plant/joystick/settings.h"
#include "record_config.h"
#include "safety/settings.h"
#include "supervisor_config.h"

namespace kadans {

struct PresetConfig {
  PlacedName name;
  std::vector<NumberEntry> values;  // key: pattern over the object's parameter names
};

struct ObjectConfig {
  std::string name;
  TextPlace place;
  PlacedName type;
  std::vector<std::size_t> joints;       // in the order of the model
  std::uint32_t divisor = 1;             // the low level runs every n-th control tick
  std::uint32_t high_level_divisor = 1;  // the high level runs every n-th behavior tick
  double switch_dwell_s = 0;             // least time between two switches of it
  std::vector<TextEntry> options;        // settings of its type other than parameters
  std::vector<NumberEntry> parameters;   // key: pattern over the parameters' names without the object's name
  std::vector<PresetConfig> presets;
};

// The posture that the robot takes after a behavior has failed.
struct SafeConfig {
  std::string pose;  // "": the robot holds its last set-points
  double after_s = 0.5;
  double time_s = 1.5;
};

struct RobotConfig {
  std::string file;
  std::string name;
  std::vector<PlacedName> plugins;  // shared libraries with types of control objects and of plants, as written
  RobotModel model;
  std::vector<InputProblem> urdf_warnings;
  EngineSettings engine;
  PlantSettings plant;
  PlantTypes plant_types = kadans::plant_types();  // with this robot's settings
  imu::SerialImuSettings serial_imu;               // beside a bus with drives
  JoystickSettings joystick;                       // engine.joystick is true when the file has one
  EstimateSettings estimate;
  SafetySettings safety;
  std::vector<ObjectConfig> objects;
  std::vector<ControlSetInfo> sets;
  SetMask initial_sets = 1;
  std::vector<std::uint32_t> at_drives;  // objects in no set, see control_sets.h
  SwitchSettings switching;
  std::vector<UnheldLaw> unheld;  // one for each joint
  std::vector<PoseInfo> poses;
  std::vector<BehaviorValue> behavior_values;  // checked against the behavior's parameters when it is loaded
  std::string start_pose;
  SafeConfig safe;
  RecordConfig record;
  std::vector<InputEvent> input_events;
  SupervisorConfig supervisor;
};

// Throws InputError with all mistakes, those of the URDF included. `object_types` are the types of control objects that
// the program knows. When it is empty, types of control objects are not checked, and a file that names plug-ins may
// have settings of any type of plant, for the plug-ins that may bring them are not loaded. `plants` are the types of
// plants that the robot's plug-ins brought.
RobotConfig read_robot_config(const std::filesystem::path& file, std::span<const std::string> object_types,
                              std::span<const MakePlantType> plants = {});
RobotConfig read_robot_config_text(const std::string& text, const std::string& file,
                                   std::span<const std::string> object_types,
                                   std::span<const MakePlantType> plants = {});

// A plug-in that the file names; its file exists.
struct PluginFile {
  std::filesystem::path file;
  TextPlace place;
};
// Reads the plug-ins alone, because they must be loaded before the types of control objects and plants are known.
// Throws InputError when the file is no JSON or names a plug-in that does not exist. read_robot_config reports all
// other mistakes.
std::vector<PluginFile> read_plugin_files(const std::filesystem::path& robot);

// Sets the configured parameters in the tables of `catalog` and fills the objects' presets. The catalog's objects must
// have been made from config.objects in the same order. Throws InputError for a pattern that fits no parameter of the
// object, with the nearest name, and for a value out of a parameter's range.
void apply_parameters(const RobotConfig& config, Catalog& catalog);

// The fields of the file, for the schema.
FieldInfo describe_robot_config();

}  // namespace kadans
