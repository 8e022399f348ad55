// The string library under a budget. What works long in C is charged before it begins. find, match, gmatch and gsub use
// a matcher that counts its steps (pattern_matcher.h).
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "handle.h"
#include "pattern_matcher.h"
#include "sandbox.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr double string_bytes_max = 64 * 1024;
constexpr double directive_instructions = 40, long_number_instructions = 500, percent_instructions = 3;
constexpr double letters_per_instruction = 4;

std::string_view check_text(lua_State* state, int index) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, index, &length);
  return {text, length};
}

// rep(text, n): up to 64 kB.
int rep(lua_State* state) {
  const std::size_t length = check_text(state, 1).size();
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
  core_of(state).budget.charge(state, static_cast<double>(check_text(state, 1).size()) / letters_per_instruction);
  return forward(state);
}

// sub(text, first [, last]): as in Lua; the piece is at most the whole.
int piece(lua_State* state) {
  charge_text(state, static_cast<double>(check_text(state, 1).size()));
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
  const std::string_view text = check_text(state, 1);
  charge_text(state, static_cast<double>(text.size()));
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

constexpr std::string_view special_characters = "^$*+?.([%-";
constexpr double plain_bytes_per_instruction = 4;
constexpr std::size_t template_steps = 3, text_steps = 48, value_steps = 160,
                      number_steps = 1200;  // of what replaces a match

// The place of the subject where the search begins: argument `index`, counted from 1, or from the end when negative.
std::size_t search_start(lua_State* state, int index, std::size_t length) {
  std::int64_t start = optional_place(state, index, 1);
  start = start < 0 ? start + static_cast<std::int64_t>(length) : start - 1;
  return std::min(static_cast<std::size_t>(std::max<std::int64_t>(start, 0)), length);
}

int push_places(lua_State* state, const char* text, const char* begin, const char* end) {
  lua_pushinteger(state, begin - text + 1);
  lua_pushinteger(state, end - text);
  return 2;
}

int find_plain(lua_State* state, std::string_view subject, std::string_view wanted, std::size_t start) {
  // memmem takes time in proportion to the two lengths, whatever they hold.
  core_of(state).budget.charge(
      state, static_cast<double>(subject.size() - start + wanted.size()) / plain_bytes_per_instruction);
  const void* found = memmem(subject.data() + start, subject.size() - start, wanted.data(), wanted.size());
  if (found == nullptr) return lua_pushnil(state), 1;
  const auto* begin = static_cast<const char*>(found);
  return push_places(state, subject.data(), begin, begin + wanted.size());
}

int search(lua_State* state, bool finds) {
  const std::string_view subject = check_text(state, 1), pattern = check_text(state, 2);
  const std::size_t start = search_start(state, 3, subject.size());
  if (finds && (lua_toboolean(state, 4) != 0 || pattern.find_first_of(special_characters) == std::string_view::npos))
    return find_plain(state, subject, pattern, start);
  const bool anchored = pattern.starts_with('^');
  PatternMatcher matcher(state, subject, pattern.data() + (anchored ? 1 : 0));
  int results = 0;
  if (!matcher.find(subject.data() + start, anchored)) {
    lua_pushnil(state);
    results = 1;
  } else if (finds) {
    results = push_places(state, subject.data(), matcher.begin(), matcher.end()) + matcher.push_captures(false);
  } else {
    results = matcher.push_captures(true);
  }
  matcher.settle();
  return results;
}

// find(text, pattern [, init [, plain]]), match(text, pattern [, init]): as in Lua.
int find(lua_State* state) { return search(state, true); }
int match(lua_State* state) { return search(state, false); }

// Upvalues: the subject, the pattern, where to go on.
int next_match(lua_State* state) {
  std::size_t length = 0;
  const char* text = lua_tolstring(state, lua_upvalueindex(1), &length);
  const auto from = static_cast<std::size_t>(lua_tointeger(state, lua_upvalueindex(3)));
  if (from > length) return 0;
  PatternMatcher matcher(state, {text, length}, lua_tostring(state, lua_upvalueindex(2)));
  const bool found = matcher.find(text + from, false);
  int results = 0;
  if (found) {
    const std::ptrdiff_t behind = matcher.end() - text;
    lua_pushinteger(state, matcher.end() == matcher.begin() ? behind + 1 : behind);  // goes on behind an empty match
    lua_replace(state, lua_upvalueindex(3));
    results = matcher.push_captures(true);
  }
  matcher.settle();
  return results;
}

// gmatch(text, pattern): as in Lua; '^' is a character like others.
int gmatch(lua_State* state) {
  (void)check_text(state, 1);
  (void)check_text(state, 2);
  lua_settop(state, 2);
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, next_match, 3);
  return 1;
}

// Adds argument 3, where %1 is a capture and %0 the match.
void add_template(lua_State* state, luaL_Buffer& buffer, PatternMatcher& matcher) {
  const std::string_view text = check_text(state, 3);
  matcher.meter().spend(template_steps * text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      luaL_addchar(&buffer, text[i]);
      continue;
    }
    const char c = text.data()[++i];  // '\0' behind the end
    if (c == '0') {
      const auto length = static_cast<std::size_t>(matcher.end() - matcher.begin());
      matcher.meter().spend(StepMeter::of_bytes(length));
      luaL_addlstring(&buffer, matcher.begin(), length);
    } else if (c >= '1' && c <= '9') {
      matcher.push_capture(c - '1');
      luaL_addvalue(&buffer);
    } else {
      luaL_addchar(&buffer, c);
    }
  }
}

// Adds what takes the place of the last match: from a text, a table or a function at argument 3.
void add_replacement(lua_State* state, luaL_Buffer& buffer, PatternMatcher& matcher, int type) {
  matcher.meter().spend(type == LUA_TSTRING || type == LUA_TNUMBER ? text_steps : value_steps);
  if (type == LUA_TTABLE) {
    matcher.push_capture(0);
    lua_gettable(state, 3);
  } else if (type == LUA_TFUNCTION) {
    lua_pushvalue(state, 3);
    lua_call(state, matcher.push_captures(true), 1);
  } else {
    return add_template(state, buffer, matcher);
  }
  const auto length = static_cast<std::size_t>(matcher.end() - matcher.begin());
  if (lua_toboolean(state, -1) == 0) {  // stays as it was
    lua_pop(state, 1);
    matcher.meter().spend(StepMeter::of_bytes(length));
    return luaL_addlstring(&buffer, matcher.begin(), length);
  }
  if (lua_isstring(state, -1) == 0) luaL_error(state, "invalid replacement value (a %s)", luaL_typename(state, -1));
  matcher.meter().spend(lua_type(state, -1) == LUA_TNUMBER ? number_steps : StepMeter::of_bytes(lua_objlen(state, -1)));
  luaL_addvalue(&buffer);
}

// gsub(text, pattern, replacement [, n]): as in Lua.
int gsub(lua_State* state) {
  const std::string_view subject = check_text(state, 1), pattern = check_text(state, 2);
  const int type = lua_type(state, 3);
  const int most = luaL_optint(state, 4, static_cast<int>(subject.size() + 1));
  if (type != LUA_TNUMBER && type != LUA_TSTRING && type != LUA_TFUNCTION && type != LUA_TTABLE)
    return luaL_argerror(state, 3, "string/function/table expected");
  begin_callback(state, "string.gsub");
  const bool anchored = pattern.starts_with('^');
  PatternMatcher matcher(state, subject, pattern.data() + (anchored ? 1 : 0));
  const char* from = subject.data();
  const char* const last = from + subject.size();
  luaL_Buffer buffer;
  luaL_buffinit(state, &buffer);
  int count = 0;
  while (count < most && matcher.find(from, anchored)) {
    luaL_addlstring(&buffer, from, static_cast<std::size_t>(matcher.begin() - from));
    ++count;
    add_replacement(state, buffer, matcher, type);
    from = matcher.end();
    const bool empty = matcher.end() == matcher.begin();
    if (empty && from < last) luaL_addchar(&buffer, *from++);
    if (anchored || (empty && matcher.end() == last)) break;
  }
  luaL_addlstring(&buffer, from, static_cast<std::size_t>(last - from));
  luaL_pushresult(&buffer);
  matcher.settle();
  end_callback(state);
  lua_pushinteger(state, count);
  return 2;
}

}  // namespace

void open_strings(lua_State* state) {
  const luaL_Reg functions[] = {{"find", find}, {"match", match}, {"gmatch", gmatch}, {"gsub", gsub}};
  set_functions(state, functions);
  wrap(state, "rep", rep);
  for (const char* name : {"lower", "reverse", "upper"}) wrap(state, name, whole);
  wrap(state, "sub", piece);
  wrap(state, "byte", byte);
  wrap(state, "char", character);
  wrap(state, "format", format_text);
}

}  // namespace kadans
