// Where a URDF's mesh files are: plain paths start from the URDF's folder, file:// is absolute, package://NAME/path
// looks for a folder NAME that holds the path, from the URDF's folder upwards (no ROS installation is asked).
#pragma once

#include <optional>
#include <string>

namespace kadans {

std::optional<std::string> find_mesh(const std::string& name_in_urdf, const std::string& urdf_file);

}  // namespace kadans
