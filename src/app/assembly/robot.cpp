// Makes a robot's control objects from its configuration.
#include "robot.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "control/plugin_library.h"
#include "kadans/estimate/velocity_filter.h"

namespace kadans {

// A type is made by make_TYPE, which its own source defines.
#define ADD_TYPE(type)                                                  \
  std::unique_ptr<ControlObject> make_##type(const ObjectSetup& setup); \
  types.add(#type, make_##type)

// One line for each type, by its "type" in a robot's configuration.
void add_shipped_types(ControlObjectTypes& types) {
  ADD_TYPE(joint_pid);
  ADD_TYPE(joint_cascade);
  ADD_TYPE(joint_impedance);
  ADD_TYPE(joint_integrator);
  ADD_TYPE(joint_velocity);
  ADD_TYPE(trajectory_list);
  ADD_TYPE(profile_position);
  ADD_TYPE(feedforward_player);
  ADD_TYPE(computed_torque);
  ADD_TYPE(dcm_balance);
  ADD_TYPE(dcm_walk);
  ADD_TYPE(stance);
  ADD_TYPE(stance_leg);
  ADD_TYPE(support_forces);
  ADD_TYPE(gravity_compensation);
  ADD_TYPE(gaze);
  ADD_TYPE(spring_torque);
  ADD_TYPE(task_impedance);
  ADD_TYPE(whole_body);
}
#undef ADD_TYPE

namespace {

ObjectOptions options_of(const ObjectConfig& object) {
  std::map<std::string, std::string> texts;
  for (const TextEntry& entry : object.options) texts[entry.key] = entry.text;
  return texts;
}

// The place of an option's text, or of the object when the option is not given.
TextPlace place_of(const ObjectConfig& object, const std::string& option) {
  const auto given = std::ranges::find(object.options, option, &TextEntry::key);
  return given == object.options.end() ? object.place : given->text_place;
}

void refuse_unasked(const RobotConfig& config, const ObjectConfig& object, const std::vector<std::string>& asked) {
  for (const TextEntry& entry : object.options) {
    if (std::ranges::find(asked, entry.key) != asked.end()) continue;
    if (asked.empty()) {
      refuse(config.file, entry.place, "control objects of type " + in_quotes(object.type.name) + " have no options");
    }
    refuse_unknown(config.file, {entry.key, entry.place}, "option", asked);
  }
}

std::unique_ptr<ControlObject> make_object(const Robot& robot, const ObjectConfig& object,
                                           const std::vector<DriveLaw>& drives) {
  const RobotConfig& config = robot.config;
  const MakeControlObject* make = robot.types.find(object.type.name);
  if (make == nullptr) refuse_unknown(config.file, object.type, "type of control object", robot.types.names());
  const ObjectSetup setup{config.model, object.joints, options_of(object), drives};
  try {
    std::unique_ptr<ControlObject> made = (*make)(setup);
    if (!made) throw std::invalid_argument("its type made no object");
    refuse_unasked(config, object, setup.options.asked());
    return made;
  } catch (const OptionError& error) {
    refuse(config.file, place_of(object, error.option()),
           "control object " + in_quotes(object.name) + ": " + error.what());
  } catch (const std::invalid_argument& error) {
    refuse(config.file, object.place, "control object " + in_quotes(object.name) + ": " + error.what());
  }
}

void declare(const RobotConfig& config, const ObjectConfig& object, ControlObject& made, Declaration& declaration) {
  try {
    made.declare(declaration);
  } catch (const std::invalid_argument& error) {
    refuse(config.file, object.place, "control object " + in_quotes(object.name) + ": " + error.what());
  }
}

// Seen from a coupled joint both of its drives act; what the other joint's error does to it is left out.
void add_both_drives(const Transmission& transmission, const std::vector<DriveSettings>& drives,
                     std::vector<DriveLaw>& laws) {
  for (std::size_t j = 0; j < 2; ++j) {
    DriveLaw& law = laws[transmission.joints()[j]];
    law.position_gain_Nm_per_rad = law.velocity_gain_Nms_per_rad = law.rotor_inertia_kg_m2 = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const DriveSettings& drive = drives[transmission.joints()[i]];
      const double share = transmission.drive_per_joint(i, j) * transmission.drive_per_joint(i, j);
      law.position_gain_Nm_per_rad += share * drive.position_gain_Nm_per_rad;
      law.velocity_gain_Nms_per_rad += share * drive.velocity_gain_Nms_per_rad;
      law.rotor_inertia_kg_m2 += share * drive.rotor_inertia_kg_m2;
    }
  }
}

std::vector<DriveLaw> drive_laws(const RobotConfig& config) {
  const EstimateSettings& estimate = config.estimate;
  std::vector<DriveLaw> laws;
  for (std::size_t i = 0; i < config.model.joints.size(); ++i) {
    const DriveSettings& drive = config.plant.drives[i];
    const std::uint32_t divisor = i < estimate.sample_divisor.size() ? estimate.sample_divisor[i] : 1;
    laws.push_back({.effort_max_Nm = config.safety.joints[i].effort_max_Nm,
                    .position_gain_Nm_per_rad = drive.position_gain_Nm_per_rad,
                    .velocity_gain_Nms_per_rad = drive.velocity_gain_Nms_per_rad,
                    .velocity_delay_s = VelocityFilter::delay_s(
                        {.cutoff_Hz = estimate.cutoff_Hz(i), .dt_s = divisor * config.engine.control_period_s}),
                    .spring_Nm_per_rad = drive.spring_Nm_per_rad,
                    .rotor_inertia_kg_m2 = drive.rotor_inertia_kg_m2,
                    .own_rotor_inertia_kg_m2 = drive.rotor_inertia_kg_m2,
                    .own_effort_max_Nm = drive.torque_max_Nm});
  }
  for (const Transmission& transmission : config.model.transmissions) {
    if (transmission.coupled()) add_both_drives(transmission, config.plant.drives, laws);
  }
  return laws;
}

}  // namespace

Robot read_robot(const std::filesystem::path& file, const PluginGate& gate) {
  Robot robot;
  std::vector<MakePlantType> plants;
  add_shipped_types(robot.types);
  robot.types.add_registered();
  for (const PluginFile& plugin : read_plugin_files(file)) {
    if (!gate.lets_in(plugin.file))
      refuse(file.string(), plugin.place, "plug-in " + plugin.file.string() + " is not loaded: " + gate.remedy);
    try {
      load_plugin(plugin.file, robot.types, plants);
      (void)plant_types(plants);  // tells of a name that is taken
    } catch (const std::invalid_argument& error) {
      refuse(file.string(), plugin.place, error.what());
    }
  }
  robot.config = read_robot_config(file, robot.types.names(), plants);
  return robot;
}

std::unique_ptr<ControlSystem> make_control_system(const Robot& robot) {
  const RobotConfig& config = robot.config;
  auto system = std::make_unique<ControlSystem>();
  Catalog& catalog = system->catalog;
  catalog.model = &config.model;
  catalog.sets = config.sets;
  catalog.poses = config.poses;
  catalog.initial_sets = config.initial_sets;
  catalog.at_drives = config.at_drives;
  catalog.drives = drive_laws(config);
  catalog.switching = config.switching;
  catalog.unheld = config.unheld;
  catalog.behavior_values = config.behavior_values;
  for (const EstimateFoot& foot : config.estimate.feet) catalog.feet.push_back({foot.name, foot.link});
  catalog.sensors = config.plant.channels;
  catalog.seen = config.supervisor.seen;
  for (const ObjectConfig& object : config.objects) {
    const auto index = static_cast<std::uint32_t>(system->objects.size());
    system->objects.push_back(make_object(robot, object, catalog.drives));
    Declaration declaration(object.name, index, catalog.parameters, catalog.setpoints, catalog.signals);
    const auto first_parameter = static_cast<ParameterId>(catalog.parameters.size());
    const auto first_setpoint = static_cast<SetpointId>(catalog.setpoints.size());
    declare(config, object, *system->objects.back(), declaration);
    ObjectInfo info{.name = object.name,
                    .type = object.type.name,
                    .joints = object.joints,
                    .parameters = {},
                    .setpoints = {},
                    .presets = {},
                    .divisor = object.divisor,
                    .high_level_divisor = object.high_level_divisor,
                    .switch_dwell_s = object.switch_dwell_s,
                    .foresight = system->objects.back()->foresight()};
    for (ParameterId id = first_parameter; id < catalog.parameters.size(); ++id) info.parameters.push_back(id);
    for (SetpointId id = first_setpoint; id < catalog.setpoints.size(); ++id) info.setpoints.push_back(id);
    catalog.objects.push_back(std::move(info));
  }
  apply_parameters(config, catalog);
  for (const auto& object : system->objects) object->parameters_changed();
  return system;
}

}  // namespace kadans
