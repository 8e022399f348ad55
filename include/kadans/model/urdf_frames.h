// The frames of a robot as its URDF names them, for viewers that draw the URDF. Frames on fixed joints, which a
// RobotModel merges away, are among them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kadans/model/robot_model.h"

namespace kadans {

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
