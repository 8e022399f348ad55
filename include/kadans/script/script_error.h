// Why a script stopped. Fixed buffers: it is filled while Lua is raising, out of memory perhaps.
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
  std::array<char, 768> message{};  // without the place
  std::array<char, 3072> traceback{};

  void clear() noexcept { *this = ScriptError{}; }
  // Takes "file:line: message" apart.
  void set_message(const char* text) noexcept;
  void set_traceback(const char* text) noexcept;
  void set_place(const char* chunk, int at_line) noexcept;
  std::string text() const;  // "file:line: message"
};

}  // namespace kadans
