// Why a script stopped. It has fixed buffers, because it is filled while Lua raises, perhaps when it is out of memory.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace kadans {

enum class ScriptBreach : std::uint8_t { none, instructions, wall_time, memory, interrupted };

struct ScriptError {
  ScriptBreach breach = ScriptBreach::none;
  bool set = false;
  int line = 0;  // 0: unknown
  std::array<char, 128> file{};
  std::array<char, 768> message{};  // without file and line
  std::array<char, 3072> traceback{};

  void clear() noexcept { *this = ScriptError{}; }
  // Splits "file:line: message" into its parts.
  void set_message(const char* text) noexcept;
  void set_traceback(const char* text) noexcept;
  void set_place(const char* chunk, int at_line) noexcept;
  std::string text() const;  // "file:line: message"
};

}  // namespace kadans
