// URDF, read strictly: what urdfdom would repair, drop or only log is refused here.
#pragma once

#include <stdexcept>
#include <string>

#include "kadans/model/robot_model.h"

namespace kadans {

struct UrdfOptions {
  bool mesh_hulls = false;  // meshes collide as their convex hulls; else a collision mesh is refused
};

// Throws InputError (signal/input_error.h) on any mistake: one message with all mistakes that were found, one per line.
RobotModel read_urdf(const std::string& file, const UrdfOptions& options = {});
// `file` only names the text in messages.
RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options = {});

}  // namespace kadans
