// What describes a robot: URDF, xacro, in which many are written, or MJCF, as its first element says. All become the
// text of a URDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kadans/model/mjcf.h"

namespace kadans {

bool is_robot_description(const std::filesystem::path& file);  // by its name; .xml only where it is MJCF

// What --package says, NAME=FOLDER each. Throws InputError for other words, or a folder that is not there.
UrdfPackages packages_of(const std::vector<std::string>& options);
inline constexpr const char* package_help =
    "Folder of a package that a URDF names in package://NAME/... (default: ROS_PACKAGE_PATH, and the URDF's folder "
    "upwards)";

// Throws InputError for what cannot be read, and for xacro where the program `xacro`, which expands it, is not
// installed or fails; `warnings` gets the others.
RobotDescription read_robot_description(const std::filesystem::path& file, const UrdfOptions& options,
                                        std::vector<InputProblem>* warnings = nullptr);

}  // namespace kadans
