// Paths inside a file are meant from the root of the project that the file belongs to, so that a copied or installed
// tree works on its own, from any working directory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "kadans/config/problems.h"

namespace kadans {

// The nearest folder above `file` that holds at least two of the folders `config`, `models` and `behaviors`. A file
// outside any project belongs to the project around the working directory, else to its own folder.
std::filesystem::path project_root(const std::filesystem::path& file);

// A path as written inside `file`: absolute paths stay, "./x" and "../x" are meant from the file's folder, all others
// from its project root.
std::filesystem::path resolve(std::string_view path, const std::filesystem::path& file);

// resolve, for something that must be an existing file: else adds a problem at `place`, with the nearest file that is
// there, and gives an empty path. `what` names the key for people: "urdf".
std::filesystem::path resolve_file(std::string_view path, TextPlace place, std::string_view what, Problems& problems);

}  // namespace kadans
