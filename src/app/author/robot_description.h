// What describes a robot: URDF, xacro, in which many are written, or MJCF. All become the text of a URDF.
#pragma once

#include <filesystem>
#include <vector>

#include "kadans/model/mjcf.h"

namespace kadans {

bool is_robot_description(const std::filesystem::path& file);  // by its name; .xml only where it is MJCF

// Throws InputError for what cannot be read, and for xacro where the program `xacro`, which expands it, is not
// installed or fails; `warnings` gets the others.
RobotDescription read_robot_description(const std::filesystem::path& file, const UrdfOptions& options,
                                        std::vector<InputProblem>* warnings = nullptr);

}  // namespace kadans
