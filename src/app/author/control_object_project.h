// The files that `kadans new control-object` writes: a folder with a control object, its test, and a program or a
// plug-in that contains it. The folder builds and its test passes without changes, on its own (find_package(kadans))
// and as a subdirectory of a project that already contains Kadans.
#pragma once

#include <string>
#include <vector>

namespace kadans {

struct ProjectFile {
  std::string name;
  std::string text;
};

struct ControlObjectNames {
  std::string type;        // "knee_damper": the name of the type, the folder and the files
  std::string class_name;  // "KneeDamper"
};

// Throws std::invalid_argument unless the name consists of words of a-z and 0-9 that begin with a letter and are joined
// by _.
ControlObjectNames control_object_names(const std::string& type);

std::vector<ProjectFile> control_object_project(const ControlObjectNames& names, bool plugin);

}  // namespace kadans
