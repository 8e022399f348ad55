// A small sound URDF, and what read_urdf_text says when a piece of it is replaced.
#pragma once

#include <string>

namespace kadans {

struct BrokenUrdf {
  const char* what;  // is wrong
  std::string from, to;
  std::string message;  // the whole error, "duo.urdf:line:column: ..."; several lines for several mistakes
};

extern const std::string duo_urdf;

std::string read_error(const std::string& text);                       // "no error" when the text is accepted
std::string duo_with(const std::string& from, const std::string& to);  // throws when `from` is not in it
void check_refused(const BrokenUrdf& broken);

}  // namespace kadans
