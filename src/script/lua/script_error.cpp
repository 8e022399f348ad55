#include "script_error.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>

namespace kadans {
namespace {

void copy(std::span<char> to, const char* from, std::size_t length) noexcept {
  const std::size_t taken = std::min(length, to.size() - 1);
  std::memcpy(to.data(), from, taken);
  to[taken] = '\0';
}

}  // namespace

void ScriptError::set_traceback(const char* text) noexcept { copy(traceback, text, std::strlen(text)); }

void ScriptError::set_place(const char* chunk, int at_line) noexcept {
  copy(file, chunk, std::strlen(chunk));
  line = at_line;
}

void ScriptError::set_message(const char* text) noexcept {
  set = true;
  const char* rest = text;
  for (const char* colon = std::strchr(text, ':'); colon != nullptr; colon = std::strchr(colon + 1, ':')) {
    char* end = nullptr;
    const long number = std::strtol(colon + 1, &end, 10);
    if (end == colon + 1 || *end != ':' || number <= 0) continue;
    copy(file, text, static_cast<std::size_t>(colon - text));
    line = static_cast<int>(number);
    rest = end + 1 + std::strspn(end + 1, " ");
    break;
  }
  copy(message, rest, std::strlen(rest));
}

std::string ScriptError::text() const {
  if (line == 0) return message.data();
  return std::string(file.data()) + ':' + std::to_string(line) + ": " + message.data();
}

}  // namespace kadans
