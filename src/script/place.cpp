#include "place.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "kadans/script/lua_state.h"
#include "kadans/signal/nearest_name.h"
#include "lua_core.h"

namespace kadans {
namespace {

bool is_among(const char* key, const char* const* names) noexcept {
  for (; *names != nullptr; ++names) {
    if (std::strcmp(key, *names) == 0) return true;
  }
  return false;
}

void describe(const char* what, const char* key, const char* const* names, char* text, std::size_t size) {
  std::vector<std::string> candidates;
  std::string known;
  for (; *names != nullptr; ++names) {
    candidates.emplace_back(*names);
    known += (known.empty() ? "" : ", ") + candidates.back();
  }
  const std::string hint = did_you_mean(key, candidates);
  if (hint.empty()) {
    std::snprintf(text, size, "%s has no key '%s'; it may have: %s", what, key, known.c_str());
  } else {
    std::snprintf(text, size, "%s has no key '%s'%s", what, key, hint.c_str());
  }
}

}  // namespace

Place calling_place(lua_State* state, int level) {
  lua_Debug activation;
  if (lua_getstack(state, level, &activation) == 0 || lua_getinfo(state, "Sl", &activation) == 0) return {};
  if (activation.source[0] != '@') return {};
  return {activation.source + 1, activation.currentline};
}

int raise_at(lua_State* state, const Place& place, const char* needle, const char* format, ...) {
  int line = place.line;
  if (needle != nullptr) line = core_of(state).owner->line_of(place.chunk, line, needle);
  va_list arguments;
  va_start(arguments, format);
  lua_pushfstring(state, "%s:%d: ", place.chunk, line);
  lua_pushvfstring(state, format, arguments);
  va_end(arguments);
  lua_concat(state, 2);
  return lua_error(state);
}

void check_keys(lua_State* state, int table, const Place& place, const char* what, const char* const* names) {
  const char* wrong = nullptr;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const char* key = lua_tostring(state, -2);
    if (!is_among(key, names) && (wrong == nullptr || std::strcmp(key, wrong) < 0)) wrong = key;
  }
  if (wrong == nullptr) return;
  char text[400];
  describe(what, wrong, names, text, sizeof text);
  raise_at(state, place, wrong, "%s", text);
}

}  // namespace kadans
