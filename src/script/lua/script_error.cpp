
#include "script_error.h"

#include <algorithm>
#include <cstdarg>
#include <cstdlib>
#include <cstring>
#include <span>

#include "lua_core.h"
#include "lua_state.h"
#include "script/check/foreign_words.h"
#include "script/check/hint.h"

namespace kadans {
namespace {

void copy(std::span<char> to, const char* from, std::size_t length) noexcept {
  const std::size_t taken = std::min(length, to.size() - 1);
  std::memcpy(to.data(), from, taken);
  to[taken] = '\0';
}

}  // namespace

// A function in C has an address there, which differs from run to run.
void ScriptError::set_traceback(const char* text) noexcept {
  copy(traceback, text, std::strlen(text));
  constexpr std::string_view address = "]: at 0x";
  char* to = traceback.data();
  for (const char* from = to; *from != '\0';) {
    const bool here = std::string_view(from).starts_with(address);
    for (std::size_t i = 0; i < (here ? address.size() - 6 : 1); ++i) *to++ = *from++;
    if (here) from += 6 + std::strspn(from + 6, "0123456789abcdef");
  }
  *to = '\0';
}

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

void ScriptError::add_hint(bool loading) noexcept {
  const auto says = [&](const char* text) { return std::strstr(message.data(), text) != nullptr; };
  const char* hint = nullptr;
  if (loading && says("a nil value") && (says("local 's'") || says("local 'm'") || says("local 'c'")))
    hint = ": this function is called while the file is loaded; under a key it stands without brackets";
  else if (loading && says("attempt to compare") && says("userdata"))
    hint = ": a parameter has its value when the behavior runs";
  else if (says("attempt to perform arithmetic on field") && says("a nil value"))
    hint = ": nothing gave it a value; vars = { name = 0 } gives it one at the start";
  else if (says("attempt to concatenate") && (says("a boolean value") || says("a nil value")))
    hint = ": tostring(x) makes a text of it";
  else if (says("attempt to compare number with string") || says("attempt to compare string with number"))
    hint = ": tonumber(text) makes a number of it";
  const std::size_t length = std::strlen(message.data());
  if (hint != nullptr) copy(std::span(message).subspan(length), hint, std::strlen(hint));
}

std::string ScriptError::text() const {
  if (line == 0) return message.data();
  return std::string(file.data()) + ':' + std::to_string(line) + ": " + message.data();
}

namespace {

constexpr std::size_t steps_per_key = 64, steps_per_name = 8;

bool is_among(const char* key, const char* const* names) noexcept {
  for (; *names != nullptr; ++names) {
    if (std::strcmp(key, *names) == 0) return true;
  }
  return false;
}

}  // namespace

ScriptPlace calling_place(lua_State* state, int level) {
  lua_Debug activation;
  if (lua_getstack(state, level, &activation) == 0 || lua_getinfo(state, "Sl", &activation) == 0) return {};
  if (activation.source[0] != '@') return {};
  return {activation.source + 1, activation.currentline};
}

int raise_at(lua_State* state, const ScriptPlace& place, const char* needle, const char* format, ...) {
  int line = place.line;
  if (needle != nullptr) {
    const LuaCore& core = core_of(state);
    core_of(state).budget.charge(state, core.owner->search_instructions(place.chunk));
    line = core.owner->line_of(place.chunk, line, needle);
  }
  va_list arguments;
  va_start(arguments, format);
  lua_pushfstring(state, "%s:%d: ", place.chunk, line);
  lua_pushvfstring(state, format, arguments);
  va_end(arguments);
  lua_concat(state, 2);
  return lua_error(state);
}

void check_keys(lua_State* state, int table, const ScriptPlace& place, const char* what, const char* const* names) {
  const char* wrong = nullptr;
  std::size_t name_count = 0;
  while (names[name_count] != nullptr) ++name_count;
  StepMeter meter(state);
  meter.spend(core_of(state).slots.steps(state, table));
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) {
    meter.spend(steps_per_key + steps_per_name * name_count);
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const char* key = lua_tostring(state, -2);
    if (!is_among(key, names) && (wrong == nullptr || std::strcmp(key, wrong) < 0)) wrong = key;
  }
  meter.settle();
  if (wrong == nullptr) return;
  if (names_a_list(wrong) && is_among("enter", names))
    raise_at(state, place, wrong, "%s has no key '%s': states and transitions stand directly in the table", what,
             wrong);
  const std::string_view here = foreign_key(wrong);
  if (!here.empty() && is_among(here.data(), names))
    raise_at(state, place, wrong, "%s has no key '%s', did you mean '%s'?", what, wrong, here.data());
  const std::string_view transition = foreign_transition(wrong);
  if (!transition.empty() && (is_among("enter", names) || is_among("on", names)))
    raise_at(state, place, wrong, "%s has no key '%s'%s", what, wrong, transition.data());
  if (std::strcmp(wrong, "default") == 0 && is_among("min", names))
    raise_at(state, place, wrong, "%s has no key 'default': it stands first: { 1, min = 0 }", what);
  const Hint hint = make_hint(state, wrong, [&](auto& known) {
    for (const char* const* name = names; *name != nullptr; ++name) known.emplace_back(*name);
  });
  raise_at(state, place, wrong, "%s has no key '%s'%s", what, wrong, hint.data());
}

}  // namespace kadans
