// URDF, read strictly: what other readers repair, drop or only log is refused here, with its place.
#pragma once

#include <string>
#include <vector>

#include "kadans/model/robot_model.h"
#include "kadans/signal/input_error.h"

namespace kadans {

struct UrdfOptions {
  bool mesh_hulls = false;  // meshes collide as their convex hulls; else a collision mesh is refused
};

// Throws InputError on anything that keeps the text from being a model, all mistakes found in one message, one a line.
// `warnings`, when given, gets what is odd but leaves the model what the text says, sorted by place.
RobotModel read_urdf(const std::string& file, const UrdfOptions& options = {},
                     std::vector<InputProblem>* warnings = nullptr);
// `file` only names the text in messages, and is where the paths of meshes start from.
RobotModel read_urdf_text(const std::string& text, const std::string& file, const UrdfOptions& options = {},
                          std::vector<InputProblem>* warnings = nullptr);

}  // namespace kadans
