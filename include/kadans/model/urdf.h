// Reads URDF strictly. Mistakes that other readers repair, drop or only log are refused here, with their places.
#pragma once

#include <string>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/signal/input_error.h"

namespace kadans {

struct UrdfOptions {
  bool mesh_hulls = false;  // meshes collide as their convex hulls; else a collision mesh is refused
};

// Throws InputError (signal/input_error.h) on any mistake: one message with all mistakes that were found, one per line.
// `warnings`, when given, gets oddities that do not change the model, sorted by place.
RobotModel read_urdf(const std::string& file, const UrdfOptions& options = {},
                     std::vector<InputProblem>* warnings = nullptr);
// `file` only names the text in messages, and is where the paths of meshes start from.
RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options = {},
                          std::vector<InputProblem>* warnings = nullptr);

}  // namespace kadans
