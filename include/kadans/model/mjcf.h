// Reads MJCF, MuJoCo's XML, as the robots of its menagerie are written: one robot of bodies with joints of one axis,
// geoms of primitive shapes and meshes, classes of defaults, actuators, equalities of two joints, keyframes. It becomes
// a URDF (urdf.h), which is what a robot's files here hold: page, records and ROS know the robot by it. What cannot be
// said in it and would make another robot is refused with its place and what to do (closed loops, balls,
// bodies that move without any mass); everything else is a warning that says what was made of it. docs/urdf.md.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "kadans/model/urdf.h"

namespace kadans {

struct MjcfPose {  // of a <key>
  std::string name;
  std::vector<std::pair<std::string, double>> position;  // rad or m, by the name of the joint
};

struct RobotDescription {
  RobotModel model;
  std::string urdf;  // the same as text; meshes have their whole paths; what is bolted down hangs on a link `world`
  std::vector<MjcfPose> poses;
};

// True for a text whose first element is <mujoco>.
bool is_mjcf(const std::string& text);

// Throws InputError (signal/input_error.h) on any mistake, as read_urdf does; `warnings`, when given, gets oddities.
// Files that <include> names are read beside `file`, and problems in them are told by their name and line.
RobotDescription read_mjcf(const std::string& file, const UrdfOptions& options = {},
                           std::vector<InputProblem>* warnings = nullptr);
// `file` only names the text in messages, and is where the paths of meshes and of what is included start from.
RobotDescription read_mjcf_text(const std::string& text, const std::string& file, const UrdfOptions& options = {},
                                std::vector<InputProblem>* warnings = nullptr);

}  // namespace kadans
