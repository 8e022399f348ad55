// Expands xacro, the macro language in which many robot descriptions are written.
#pragma once

#include <filesystem>
#include <string>

namespace kadans {

// What the program `xacro` makes of the file: a URDF. Throws InputError with what the program says, or, where there is
// no such program, with how to do it elsewhere.
std::string expanded_xacro(const std::filesystem::path& file);

}  // namespace kadans
