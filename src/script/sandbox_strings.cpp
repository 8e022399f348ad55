// The string library under a budget: what works long in C is charged before it begins.
//
// Matching a pattern backtracks: each quantifier may be tried at every place of the subject, each '?' doubles the
// ways. The bound computed here is crude, and far above what a sane pattern costs; short subjects never notice.
#include <algorithm>
#include <cstring>

#include "library_function.h"
#include "lua_core.h"
#include "sandbox.h"

namespace kadans {
namespace {

constexpr double string_bytes_max = 64 * 1024;
constexpr double pattern_steps_max = 2e6;
constexpr double steps_per_instruction = 8;  // a step of the matcher is cheaper than an instruction of a script

double match_steps(const char* pattern, std::size_t length, double subject) {
  double steps = pattern[0] == '^' ? 1 : subject + 1;
  bool in_set = false;
  for (std::size_t i = 0; i < length; ++i) {
    const char c = pattern[i];
    if (c == '%') {
      const char kind = i + 1 < length ? pattern[++i] : '\0';
      if (!in_set && (kind == 'b' || (kind >= '0' && kind <= '9'))) steps *= subject + 1;
    } else if (in_set) {
      in_set = c != ']';
    } else if (c == '[') {
      in_set = true;
    } else if (c == '*' || c == '+' || c == '-') {
      steps *= subject + 1;
    } else if (c == '?') {
      steps *= 2;
    }
  }
  return steps + static_cast<double>(length);
}

void charge_match(lua_State* state, bool plain) {
  std::size_t subject = 0, length = 0;
  luaL_checklstring(state, 1, &subject);
  const char* pattern = luaL_checklstring(state, 2, &length);
  const double steps = plain ? static_cast<double>(subject) * static_cast<double>(std::max<std::size_t>(length, 1)) / 16
                             : match_steps(pattern, length, static_cast<double>(subject));
  if (!(steps <= pattern_steps_max)) {
    luaL_error(state, "this pattern may take %f steps on a string of %d bytes; at most %f are allowed", steps,
               static_cast<int>(subject), pattern_steps_max);
  }
  core_of(state).budget.charge(state, steps / steps_per_instruction);
}

// find(text, pattern [, init [, plain]]), match(text, pattern [, init]), gmatch(text, pattern): as in Lua.
int find(lua_State* state) { return charge_match(state, lua_toboolean(state, 4) != 0), forward(state); }
int match(lua_State* state) { return charge_match(state, false), forward(state); }

// gsub(text, pattern, replacement [, n]): as in Lua; nested callbacks are bounded.
int gsub(lua_State* state) {
  charge_match(state, false);
  return forward_nested(state, "string.gsub");
}

// rep(text, n): up to 64 kB.
int rep(lua_State* state) {
  std::size_t length = 0;
  luaL_checklstring(state, 1, &length);
  const double count = luaL_checknumber(state, 2);
  if (length == 0 || count < 1) return lua_pushliteral(state, ""), 1;
  const double bytes = static_cast<double>(length) * count;
  if (!(bytes <= string_bytes_max)) return luaL_error(state, "string.rep makes at most 64 kB at a time");
  lua_settop(state, 2);
  return forward_text(state);
}

// lower, upper, reverse, sub, byte: as in Lua; each may touch the whole string.
int whole(lua_State* state) {
  std::size_t length = 0;
  luaL_checklstring(state, 1, &length);
  charge_text(state, static_cast<double>(length));
  return forward(state);
}

// format(format, ...): as in Lua, without %p and other addresses.
int format(lua_State* state) {
  const char* text = luaL_checkstring(state, 1);
  if (std::strstr(text, "%p") != nullptr)
    return luaL_error(state, "string.format has no %%p: addresses differ from run to run");
  for (int i = 2; i <= lua_gettop(state); ++i) {
    if (lua_type(state, i) > LUA_TSTRING && luaL_getmetafield(state, i, "__tostring") == 0) {
      lua_pushstring(state, luaL_typename(state, i));
      lua_replace(state, i);
    } else if (lua_type(state, i) > LUA_TSTRING) {
      lua_pop(state, 1);
    }
  }
  begin_callback(state, "string.format");
  const int results = forward_text(state);
  end_callback(state);
  return results;
}

}  // namespace

void open_strings(lua_State* state) {
  wrap(state, "find", find);
  wrap(state, "match", match);
  wrap(state, "gmatch", match);
  wrap(state, "gsub", gsub);
  wrap(state, "rep", rep);
  for (const char* name : {"byte", "lower", "reverse", "sub", "upper"}) wrap(state, name, whole);
  wrap(state, "format", format);
}

}  // namespace kadans
