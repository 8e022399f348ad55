// A robot as its files describe it, and its control objects.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "config/robot/robot_config.h"
#include "config/scenario/scenario_config.h"
#include "kadans/control/control_object_types.h"

namespace kadans {

void add_shipped_types(ControlObjectTypes& types);

// A robot as its files describe it, and the known types of control objects.
struct Robot {
  ControlObjectTypes types;  // shipped types, types registered by this program, types of the robot's plug-ins
  RobotConfig config;
};
// Loads the plug-ins that the file names; they stay loaded. Throws InputError with all mistakes, and for a plug-in that
// the gate does not let in.
Robot read_robot(const std::filesystem::path& file, const PluginGate& gate = {});

// The control objects of a configuration with their parameters set, and the catalog that describes them.
struct ControlSystem {
  Catalog catalog;
  std::vector<std::unique_ptr<ControlObject>> objects;
};
// Throws InputError with the place of the mistake in the configuration.
std::unique_ptr<ControlSystem> make_control_system(const Robot& robot);

}  // namespace kadans
