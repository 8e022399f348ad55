// The string library under a budget, but for patterns: what works long in C is charged before it begins.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "library_function.h"
#include "sandbox.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr double string_bytes_max = 64 * 1024;
constexpr double directive_instructions = 40, long_number_instructions = 500, percent_instructions = 3;
constexpr double letters_per_instruction = 4;

// rep(text, n): up to 64 kB.
int rep(lua_State* state) {
  std::size_t length = 0;
  luaL_checklstring(state, 1, &length);
  const double count = luaL_checknumber(state, 2);
  if (length == 0 || !(count >= 1)) return lua_pushliteral(state, ""), 1;
  const double bytes = static_cast<double>(length) * count;
  if (!(bytes <= string_bytes_max)) return luaL_error(state, "string.rep makes at most 64 kB at a time");
  lua_settop(state, 2);
  charge_text(state, bytes);
  return forward(state);
}

// lower, upper, reverse: as in Lua, a letter at a time.
int whole(lua_State* state) {
  std::size_t length = 0;
  luaL_checklstring(state, 1, &length);
  core_of(state).budget.charge(state, static_cast<double>(length) / letters_per_instruction);
  return forward(state);
}

// sub(text, first [, last]): as in Lua; the piece is at most the whole.
int piece(lua_State* state) {
  std::size_t length = 0;
  luaL_checklstring(state, 1, &length);
  charge_text(state, static_cast<double>(length));
  return forward(state);
}

// byte(text [, first [, last]]), char(...): as in Lua; thousands of values at most.
int byte(lua_State* state) {
  const int results = forward(state);
  core_of(state).budget.charge(state, results / 2.0);
  return results;
}
int character(lua_State* state) {
  core_of(state).budget.charge(state, lua_gettop(state) / 2.0);
  return forward(state);
}

// What it takes to write argument `index` as a number: many digits, or an exponent far from 0, take long division.
double number_instructions(lua_State* state, int index, bool precise) {
  if (lua_isnumber(state, index) == 0) return directive_instructions;
  const double size = std::abs(lua_tonumber(state, index));
  const bool handy = size == 0 || (size > 1e-5 && size < 1e15);
  return handy && !precise ? directive_instructions : long_number_instructions;
}

// The directive behind the '%' at text[at]: charges for it and returns where it ends. LuaJIT reads on behind a '\0'.
std::size_t charge_directive(lua_State* state, std::string_view text, std::size_t at, int index) {
  const auto behind = [text](std::size_t from, std::string_view letters) {
    return std::min(text.find_first_not_of(letters, from), text.size());
  };
  at = behind(at + 1, "-+ #0123456789");
  std::size_t digits = 0;  // of the precision
  if (at < text.size() && text[at] == '.') {
    digits = behind(at + 1, "0123456789") - at - 1;
    at += 1 + digits;
  }
  const char kind = at < text.size() ? text[at] : '\0';
  if (kind == 'p') luaL_error(state, "string.format has no %%p: addresses differ from run to run");
  if (kind == 'q') core_of(state).budget.charge(state, static_cast<double>(lua_objlen(state, index)));
  core_of(state).budget.charge(state, number_instructions(state, index, digits > 1));
  return at + 1;
}

// format(format, ...): as in Lua, without %p and other addresses.
int format_text(lua_State* state) {
  std::size_t length = 0;
  const char* given = luaL_checklstring(state, 1, &length);
  const std::string_view text(given, length);
  charge_text(state, static_cast<double>(length));
  const int count = lua_gettop(state);
  int index = 1;
  for (std::size_t at = 0; (at = text.find('%', at)) != std::string_view::npos;) {
    const bool directive = text.substr(at + 1, 1) != "%";
    core_of(state).budget.charge(state, percent_instructions);
    at = directive ? charge_directive(state, text, at, std::min(++index, count)) : at + 2;
  }
  for (int i = 2; i <= count; ++i) {
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
  open_patterns(state);
  wrap(state, "rep", rep);
  for (const char* name : {"lower", "reverse", "upper"}) wrap(state, name, whole);
  wrap(state, "sub", piece);
  wrap(state, "byte", byte);
  wrap(state, "char", character);
  wrap(state, "format", format_text);
}

}  // namespace kadans
