#include "control_object_project.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>

#include "control_object_templates.h"

namespace kadans {
namespace {

constexpr std::size_t name_max = 48;

// Replaces every "@type@" and "@Class@" in a template.
std::string filled(std::string_view text, const ControlObjectNames& names) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text.substr(i).starts_with("@type@")) {
      result += names.type;
      i += 6;
    } else if (text.substr(i).starts_with("@Class@")) {
      result += names.class_name;
      i += 7;
    } else {
      result += text[i++];
    }
  }
  return result;
}

bool good(const std::string& type) {
  if (type.empty() || type.size() > name_max || type.back() == '_' || type.find("__") != std::string::npos)
    return false;
  if (!(type[0] >= 'a' && type[0] <= 'z')) return false;
  return std::ranges::all_of(type, [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

}  // namespace

ControlObjectNames control_object_names(const std::string& type) {
  if (!good(type)) {
    throw std::invalid_argument("a control object's name is words of a-z and 0-9 joined by _, at most " +
                                std::to_string(name_max) + " letters, for example knee_damper");
  }
  ControlObjectNames names{type, {}};
  bool begins = true;
  for (const char c : type) {
    if (c != '_') names.class_name += begins ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    begins = c == '_';
  }
  return names;
}

std::vector<ProjectFile> control_object_project(const ControlObjectNames& names, bool plugin) {
  std::vector<ProjectFile> files{{names.type + ".h", filled(header_template, names)},
                                 {names.type + ".cpp", filled(source_template, names)},
                                 {names.type + "_test.cpp", filled(test_template, names)}};
  files.push_back({plugin ? "plugin.cpp" : "main.cpp", filled(plugin ? plugin_template : program_template, names)});
  files.push_back({"CMakeLists.txt", filled(cmake_template, names) +
                                         filled(plugin ? cmake_plugin_template : cmake_program_template, names)});
  return files;
}

}  // namespace kadans
