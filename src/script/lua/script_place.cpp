#include "script_place.h"

#include <cstdarg>
#include <cstring>

#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/step_meter.h"

namespace kadans {
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
  const Hint hint = make_hint(state, wrong, [&](auto& known) {
    for (const char* const* name = names; *name != nullptr; ++name) known.emplace_back(*name);
  });
  raise_at(state, place, wrong, "%s has no key '%s'%s", what, wrong, hint.data());
}

}  // namespace kadans
