// `kadans new`: writes the first version of a part of a project.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace kadans {

struct NewControlObjectOptions {
  std::string name;
  std::string folder = ".";  // the object's folder is made in this folder
  bool plugin = false;
  std::string from_c;                // folder of C code that a tool has made; "": an example law
  std::optional<double> period_s{};  // of a step of that code
};
struct NewRobotOptions {
  std::string urdf, srdf, name;
  std::vector<std::string> packages;  // NAME=FOLDER
  std::string folder = ".";           // the project
  bool no_run = false;
};
// Of a behavior, a scenario or a sweep.
struct NewPartOptions {
  std::string name;
  std::string robot;     // configuration; "": the project's only robot
  std::string folder;    // the project; "": the robot's
  std::string play;      // of a scenario: a list; "": nothing plays
  std::string scenario;  // of a sweep; "": the one of its name, else the robot's only one
  bool no_run = false;
};
struct NewPlantOptions {
  std::string name;
  std::string robot;
  std::string folder = ".";  // the plant's folder is made in this folder
};

}  // namespace kadans
