// A small sound URDF, and what read_urdf_text says when a piece of it is replaced.
#pragma once

#include <string>

namespace kadans {

struct BrokenUrdf {
  const char* what;  // is wrong
  std::string from, to;
  std::string message;  // all that is told, "duo.urdf:line:column: ..."; of what is accepted "warning: duo.urdf:..."
};

extern const std::string duo_urdf;

std::string read_error(const std::string& text);                       // "no error" when the text is accepted
std::string duo_with(const std::string& from, const std::string& to);  // throws when `from` is not in it
// The error, or the warnings, each with "warning: " before it; several lines for several. Collision meshes may be
// hulls.
std::string read_told(const std::string& text);
void check_told(const BrokenUrdf& broken);

}  // namespace kadans
