// Reads URDF strictly. Mistakes that other readers repair, drop or only log are refused here, with their places.
#pragma once

#include <optional>
#include <span>
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

// The frames of a robot as its URDF names them, for viewers that draw the URDF. Frames on fixed joints, which a
// RobotModel merges away, are among them.
struct UrdfFrame {
  std::string parent, child;         // links
  std::optional<std::size_t> joint;  // the joint of the model that moves it; none: fixed
  Pose origin;                       // in the parent's frame, at position 0
};

// One frame a joint of the URDF, in the order of its names. `model` was read from this text. Throws InputError.
std::vector<UrdfFrame> urdf_frames(const RobotModel& model, const std::string& text);

// The frame's pose in its parent's frame; one position per joint of the model.
Pose frame_pose(const UrdfFrame& frame, const RobotModel& model, std::span<const double> position_rad) noexcept;

}  // namespace kadans
