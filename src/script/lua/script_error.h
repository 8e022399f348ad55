// Why a script stopped. It has fixed buffers, because it is filled while Lua raises, perhaps when it is out of memory.
#pragma once

#include <array>
#include <cstdint>
#include <string>

struct lua_State;

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
  // Goes on with what was probably meant by one of Lua's own messages.
  void add_hint(bool loading) noexcept;
  void set_traceback(const char* text) noexcept;
  void set_place(const char* chunk, int at_line) noexcept;
  std::string text() const;  // "file:line: message"
};

// The messages of bindings: a place in a script, errors raised at it, and the check of a table's keys.
struct ScriptPlace {
  const char* chunk = "";  // lives as long as the Lua state
  int line = 0;
};

// The place in the script function that calls the running C function; `level` 1 is the direct caller.
ScriptPlace calling_place(lua_State* state, int level = 1);
// Raises "file:line: message". With `needle`, the line is the first one from the place on that contains this text.
int raise_at(lua_State* state, const ScriptPlace& place, const char* needle, const char* format, ...);

// [-0 +0] Raises with the nearest name when the table at `table` has a string key that is not among `names`, which end
// with nullptr. `what` is the name of the table in messages.
void check_keys(lua_State* state, int table, const ScriptPlace& place, const char* what, const char* const* names);

}  // namespace kadans
