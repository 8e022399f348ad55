// What `kadans new control-object` writes: a folder with a control object, its test, and a program or a plug-in that
// brings it along; it builds and passes as it stands, on its own (find_package(kadans)) and as a subdirectory of a
// project that has Kadans already.
#pragma once

#include <string>
#include <vector>

namespace kadans {

struct ProjectFile {
  std::string name;
  std::string text;
};

struct ControlObjectNames {
  std::string type;        // "knee_damper": the type's name, and that of folder and files
  std::string class_name;  // "KneeDamper"
};

// Throws std::invalid_argument unless the name is words of a-z and 0-9, joined by _, that begin with a letter.
ControlObjectNames control_object_names(const std::string& type);

std::vector<ProjectFile> control_object_project(const ControlObjectNames& names, bool plugin);

}  // namespace kadans
