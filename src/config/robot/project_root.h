// Paths inside a file start at the root of the project to which the file belongs. So a copied or installed tree works
// from any working directory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "config/json/problems.h"

namespace kadans {

// The root is the nearest folder above `file` that holds at least two of the folders `config`, `models` and
// `behaviors`. A file outside any project belongs to the project around the working directory. Without one, it belongs
// to the project that is installed with this program (PREFIX/share/kadans), such as /etc/kadans/ROBOT/robot.json. Else
// its own folder is the root.
std::filesystem::path project_root(const std::filesystem::path& file);

// Whether `file` lies in the project around the working directory, links resolved. A file outside any project does not.
bool lies_in_project_here(const std::filesystem::path& file);

// Resolves a path as it is written inside `file`: an absolute path stays, "./x" and "../x" start at the file's folder,
// and all others start at its project root.
std::filesystem::path resolve(std::string_view path, const std::filesystem::path& file);

// Resolves a path that must name an existing file. If there is none, it adds a problem at `place` with the nearest
// existing file, and returns an empty path. `what` names the key for people: "urdf".
std::filesystem::path resolve_file(std::string_view path, TextPlace place, std::string_view what, Problems& problems);
std::filesystem::path resolve_file_or_folder(std::string_view path, TextPlace place, std::string_view what,
                                             Problems& problems);

// Where kadans keeps a user's files of one kind: below the folder that the variable names (XDG_CACHE_HOME), else below
// this one of his home (.cache). Empty: nowhere. The folder need not be there.
std::filesystem::path user_folder(const char* variable, const char* below_home);

}  // namespace kadans
