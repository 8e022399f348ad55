#include "robot_config.h"

#include <algorithm>

#include "config/scenario/based_on.h"
#include "config/scenario/event_text.h"
#include "config/scenario/play_item.h"
#include "kadans/model/urdf.h"
#include "kadans/signal/nearest_name.h"
#include "kadans/signal/shell_word.h"
#include "mesh_hull.h"
#include "project_root.h"
#include "robot_reader.h"

namespace kadans {
namespace {

constexpr std::size_t plugins_max = 64;

void engine_fields(Fields& f, EngineSettings& engine) {
  f.number("control_period_s", engine.control_period_s, {1e-5, 1, "s"}, "period of the control engine");
  f.number("behavior_period_s", engine.behavior_period_s, {1e-5, 10, "s"},
           "period of the behavior engine, a whole multiple of control_period_s");
  f.number("behavior_time_max_s", engine.behavior_time_max_s, {0, 10, "s"},
           "wall-clock time that one behavior may take in one tick of kadans run; 0: half of behavior_period_s");
  f.integer("commands_per_tick_max", engine.commands_per_tick_max, {max_transaction - 1, command_capacity},
            "largest number of commands applied in one control tick; the largest transaction must pass");
  f.number("command_age_max_s", engine.command_age_max_s, {1e-3, 60, "s"}, "age above which a command is refused");
  if (f.reading() && engine.behavior_divisor() == 0) {
    f.refuse("behavior_period_s", engine.behavior_period_s,
             "a whole multiple of control_period_s, " + number_text(engine.control_period_s) + " s");
  }
}

void safe_fields(Fields& f, RobotConfig& config) {
  f.string("pose", config.safe.pose, "pose to which the robot moves", Need::required);
  f.number("after_s", config.safe.after_s, {0, 60, "s"},
           "time for which the last set-points are held before the motion");
  f.number("time_s", config.safe.time_s, {0.01, 60, "s"}, "duration of the motion");
  if (!f.reading() || config.safe.pose.empty() || config.model.joints.empty())
    return;  // without a model no pose is read
  (void)f.problems().known({config.safe.pose, f.place("pose")}, "pose", names_of(config.poses));
}

const std::vector<std::string> axis_names{joystick_axis_names.begin(), joystick_axis_names.end()};
constexpr std::uint64_t axis_code_max = 63;
constexpr NumberRange any_value{-2147483648.0, 2147483647.0, ""};

void axis_fields(Fields& f, JoystickAxis& axis) {
  f.integer("code", axis.code, {0, axis_code_max}, "the kernel's number of the axis, as `evtest` shows it");
  f.boolean("inverted", axis.inverted, "the axis counts in the opposite direction");
  f.number("min", axis.min, any_value, "value at one end of the axis (default: what the device reports)");
  f.number("max", axis.max, any_value, "value at the other end of the axis");
  if (f.has("min") == f.has("max") && (!f.has("min") || axis.min < axis.max)) return;
  f.refuse(f.place("min"), f.path() + ": min and max go together, and min is less");
}

}  // namespace

void RobotReader::read(Fields& f) {
  std::string schema, base;
  f.string("$schema", schema, "the schema of this file, for editors");
  f.string("based_on", base, "another robot's configuration; this file says only what is different");
  f.string("name", config_.name, "the robot's name", Need::required);
  f.strings("plugins", config_.plugins, {1, plugins_max},
            "shared libraries that bring types of control objects and of plants, from the project root");
  load_model(f);
  f.list("transmissions", {0, max_joints}, "what stands between drives and joints, as in ros2_control",
         [&](Fields& e) { transmission(e); });
  f.object("engine", "periods and bounds of the engines",
           [&](Fields& engine) { engine_fields(engine, config_.engine); });
  f.map("poses", "positions in radians by joint pattern, for behaviors and the start", [&](Fields& e) { pose(e); });
  f.map("behaviors", "parameters of behaviors on this robot, by behavior", [&](Fields& e) { behavior(e); });
  f.object("safe", "the posture to which the robot moves when a behavior has failed",
           [&](Fields& safe) { safe_fields(safe, config_); });
  f.object("plant", "what a model of the robot has in addition to its links", [&](Fields& e) { plant(e); });
  f.map("sensors", "sensors in addition to joints, IMU and feet, by name", [&](Fields& e) { sensor(e); });
  for (auto* const channels : {&config_.estimate.channels, &config_.safety.channels})
    *channels = config_.plant.channels;
  f.object("start", "the pose and place in which the robot starts", [&](Fields& e) { start(e); });
  f.object("joystick", "a joystick that behaviors read as s.joystick", [&](Fields& e) { joystick(e); });
  f.object("estimate", "settings of the estimator", [&](Fields& e) { estimate(e); });
  f.object("supervisor", "what decides what is played, and what it knows of the world (docs/supervisor.md)",
           [&](Fields& e) {
             const std::filesystem::path folder = std::filesystem::path(config_.file).parent_path().filename();
             supervisor_fields(e, config_.supervisor, {.project_file = config_.file, .robot = folder.string()});
           });
  f.object("record", "what is recorded", [&](Fields& record) { record_fields(record, config_.record); });
  f.object("safety", "limits and reactions of the safety layer", [&](Fields& e) { safety(e); });
  f.object(
      "control", "control objects and control sets", [&](Fields& e) { control(e); }, Need::required);
}

void RobotReader::load_model(Fields& f) {
  std::string urdf;
  if (!f.string("urdf", urdf, "the robot's URDF, from the project root", Need::required)) return;
  const std::filesystem::path file = resolve_file(urdf, f.place("urdf"), "urdf", problems_);
  if (file.empty()) return;
  if (file.extension() == ".xacro")
    return f.refuse("urdf", " is xacro: expand it once, so that what runs is one file: 'xacro " + shell_word(urdf) +
                                " > FILE.urdf'");
  try {
    config_.model = read_urdf(file.string(), {.mesh_hull = mesh_hull}, &config_.urdf_warnings);
  } catch (const InputError& error) {
    problems_.add(error);
    return;
  }
  have_model_ = true;
  joint_names_ = config_.model.joint_names();
  drive_names_ = config_.model.drive_names();
  const std::size_t count = config_.model.joints.size();
  config_.plant.drives.resize(count);
  config_.plant.encoders.resize(count);
  config_.plant.position_rad.assign(count, 0.0);
  config_.estimate.spring_Nm_per_rad.assign(count, 0.0);
  config_.estimate.joint_velocity_cutoff_Hz.assign(count, 0.0);
  config_.estimate.sample_divisor.assign(count, 1);
  for (std::size_t i = 0; i < count; ++i) {
    const Joint& joint = config_.model.joints[i];
    config_.plant.drives[i].torque_max_Nm = joint.effort_max_Nm;
    config_.plant.drives[i].velocity_max_rad_s = joint.velocity_max_rad_s;
    config_.plant.drives[i].rotor_inertia_kg_m2 = joint.rotor_inertia_kg_m2;
    config_.safety.joints.push_back({std::max(joint.lower_rad, joint.soft_lower_rad),
                                     std::min(joint.upper_rad, joint.soft_upper_rad), joint.velocity_max_rad_s,
                                     joint.effort_max_Nm});
  }
  for (const Transmission& transmission : config_.model.transmissions) default_drives(transmission);
  of_urdf_ = config_.model.transmissions.size();
}

std::vector<std::size_t> RobotReader::chosen(std::string_view pattern, TextPlace place, const char* what,
                                             const std::vector<std::string>& names) {
  std::vector<std::size_t> found = matching(pattern, names);
  if (found.empty()) problems_.add_unknown(place, what, pattern, names);
  return found;
}

RobotConfig read_robot_config_text(const std::string& text, const std::string& file,
                                   std::span<const std::string> object_types, std::span<const MakePlantType> plants) {
  RobotConfig config;
  config.plant_types = plant_types(plants);
  config.file = config.record.signals.file = file;
  read_based_fields(
      text, file, [&](const std::filesystem::path& base) { return read_robot_config(base, object_types, plants); },
      [&](Fields& f) { RobotReader(config, f.problems(), object_types).read(f); });
  return config;
}

RobotConfig read_robot_config(const std::filesystem::path& file, std::span<const std::string> object_types,
                              std::span<const MakePlantType> plants) {
  return read_robot_config_text(read_input_file(file), file.string(), object_types, plants);
}

std::vector<PluginFile> read_plugin_files(const std::filesystem::path& robot) {
  const JsonValue json = parse_based_json(read_input_file(robot), robot.string()).value;
  const JsonMember* list = json.find("plugins");
  std::vector<PluginFile> files;
  if (list == nullptr) return files;
  Problems problems(robot.string());
  for (const JsonValue& name : list->value.items) {
    if (name.kind != JsonValue::Kind::string || files.size() == plugins_max) break;
    const std::filesystem::path file = resolve_file(name.text, name.place, "plugins", problems);
    if (!file.empty()) files.push_back({file, name.place});
  }
  problems.throw_if_any();
  return files;
}

FieldInfo describe_robot_config() {
  RobotConfig config;
  return describe_fields([&](Fields& f) { RobotReader(config, f.problems(), {}).read(f); });
}

void RobotReader::behavior(Fields& entry) {
  constexpr NumberRange any_number{-1e9, 1e9};
  std::vector<NumberEntry> values;
  entry.number_entries(values, any_number, "value in the parameter's unit");
  if (!entry.reading() || config_.name.empty()) return;
  const std::vector<std::string> names = playable_names({.project_file = config_.file, .robot = config_.name});
  if (!problems_.known({entry.key(), entry.key_place()}, "behavior", names, "in behaviors/" + config_.name)) return;
  for (const NumberEntry& value : values) {
    config_.behavior_values.push_back({.behavior = std::string(entry.key()),
                                       .parameter = value.key,
                                       .value = value.value,
                                       .chunk = "behaviors/" + config_.name + "/" + std::string(entry.key()) + ".lua",
                                       .file = config_.file,
                                       .line = value.place.line,
                                       .column = value.place.column});
  }
}

void RobotReader::joystick(Fields& f) {
  JoystickSettings& settings = config_.joystick;
  config_.engine.joystick = true;
  f.string("device", settings.device, "device that `kadans run` reads, such as /dev/input/by-id/NAME-event-joystick");
  f.number("dead_zone", settings.dead_zone, {0, 0.9},
           "zone around the middle of an axis that reads as 0, as a share of the way to an end");
  f.map("axes", "how axes are read: x, y, twist, throttle", [&](Fields& entry) {
    JoystickAxis scratch;
    const auto axis = problems_.known({entry.key(), entry.key_place()}, "axis", axis_names);
    axis_fields(entry, axis ? settings.axes[*axis] : scratch);
  });
  f.map("buttons", buttons_doc, [&](Fields& e) { button_fields(e, config_.input_events); });
}

}  // namespace kadans
