// The robot for which `kadans new behavior`, `scenario` and `sweep` write, and what of it they move.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "app/assembly/robot.h"

namespace kadans {

// Of a behavior, a scenario or a sweep.
struct NewPartOptions {
  std::string name;
  std::string robot;     // configuration; "": the project's only robot
  std::string folder;    // the project; "": the robot's
  std::string play;      // of a scenario: a list; "": nothing plays
  std::string scenario;  // of a sweep; "": the one of its name, else the robot's only one
  bool no_run = false;
};

struct NewSubject {
  std::filesystem::path project;  // its root
  std::string robot_file;         // from there
  Robot robot;
  std::unique_ptr<ControlSystem> system;

  const RobotModel& model() const noexcept { return robot.config.model; }
  bool stands() const noexcept { return !robot.config.plant.fixed_base; }
  std::filesystem::path file() const { return project / robot_file; }
  // The folder in behaviors/ in which names of its behaviors are looked up.
  std::string behaviors_folder() const { return file().parent_path().filename().string(); }
};

// The folder that --in names, else the working directory.
std::filesystem::path folder_of(const NewPartOptions& options);
// A file that an option names, by its path from here or else from that folder.
std::filesystem::path file_named(const std::filesystem::path& name, const std::filesystem::path& folder);

// Throws InputError where there is no such robot, or it lies in no project or in another one than the options name.
NewSubject read_subject(const NewPartOptions& options);

// One joint that may be moved aside while the robot stands as it starts: of those that no foot hangs on, the one that
// carries the least; else, by little, one of a leg.
struct AsideJoint {
  const ControlSetInfo* set = nullptr;  // on which it is moved ...
  const ObjectInfo* object = nullptr;   // ... by this object
  const Joint* joint = nullptr;
  double home = 0, aside = 0;  // where it starts; by how much it moves, rad, or m of a slider
  double most = 0;             // as far as its limits allow in that direction, > 0
};
// Throws InputError when no control set of the robot has an object that leads joints by their positions.
AsideJoint joint_aside(const NewSubject& subject);

// The option --robot, --in and --no-run of them all.
void add_part_options(CLI::App& command, NewPartOptions& options, const char* name, const char* not_run);

}  // namespace kadans
