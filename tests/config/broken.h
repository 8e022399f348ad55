// A text that is right, broken in one place, and the message that it must give.
#pragma once

#include <string>

#include "kadans/signal/input_error.h"

namespace kadans {

struct Broken {
  const char* find;     // first occurrence in the right text ...
  const char* replace;  // ... becomes this
  const char* message;  // "line:column: what is wrong", one a line; the project's root is written ROOT
};

inline std::string replaced(std::string text, const std::string& find, const std::string& replace) {
  const std::size_t at = find.empty() ? std::string::npos : text.find(find);
  return at == std::string::npos ? text : text.replace(at, find.size(), replace);
}

// What `read` refuses, each problem without the name of `file` and with ROOT for `root`; "" when it refuses nothing.
template <typename Read>
std::string refusal(const std::string& file, const std::string& root, Read&& read) {
  try {
    read();
  } catch (const InputError& error) {
    std::string text;
    for (const InputProblem& problem : error.problems()) {
      std::string line = problem.text();
      if (line.starts_with(file + ":")) line.erase(0, file.size() + 1);
      text += (text.empty() ? "" : "\n") + replaced(line, root, "ROOT");
    }
    return text;
  }
  return "";
}

}  // namespace kadans
