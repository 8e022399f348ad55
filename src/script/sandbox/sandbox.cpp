
#include "sandbox.h"

#include <cstdio>
#include <cstring>
#include <filesystem>

#include "handle.h"
#include "script/check/foreign_words.h"
#include "script/check/hint.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"

namespace kadans {
namespace {

constexpr int callback_depth_max = 16;  // C frames of gsub and print are large
constexpr double text_bytes_per_instruction = 12;

}  // namespace

void wrap(lua_State* state, const char* name, lua_CFunction function) {
  lua_getfield(state, -1, name);
  lua_pushcclosure(state, function, 1);
  lua_setfield(state, -2, name);
}

int forward(lua_State* state) {
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, lua_gettop(state) - 1, LUA_MULTRET);
  return lua_gettop(state);
}

int forward_text(lua_State* state) {
  const int results = forward(state);
  if (results > 0 && lua_type(state, 1) == LUA_TSTRING) charge_text(state, static_cast<double>(lua_objlen(state, 1)));
  return results;
}

void begin_callback(lua_State* state, const char* name) {
  LuaCore& core = core_of(state);
  if (core.depth >= callback_depth_max) luaL_error(state, "%s is nested too deeply", name);
  ++core.depth;
}

void end_callback(lua_State* state) noexcept { --core_of(state).depth; }

void charge_text(lua_State* state, double bytes) {
  core_of(state).budget.charge(state, bytes / text_bytes_per_instruction);
}

std::int32_t to_place(lua_Number number) noexcept {
  return number > -2147483649.0 && number < 2147483648.0 ? static_cast<std::int32_t>(number) : INT32_MIN;
}

std::int32_t optional_place(lua_State* state, int index, std::int32_t otherwise) {
  return lua_isnoneornil(state, index) ? otherwise : to_place(luaL_checknumber(state, index));
}

namespace {

const char environment_key = 0;
const char content_key = 0;
const char filler_key = 0;

int refuse_write(lua_State* state) {  // (proxy, key, value); upvalue: name
  const char* name = lua_tostring(state, lua_upvalueindex(1));
  const char* key = lua_type(state, 2) == LUA_TSTRING ? lua_tostring(state, 2) : "?";
  if (*name == '\0') return luaL_error(state, "'%s' would be a global: write local %s", key, key);
  return luaL_error(state, "%s is read-only: '%s' cannot be set", name, key);
}

int refuse_read(lua_State* state) {  // (content, key); upvalues: name, content
  return raise_unknown_field(state, lua_tostring(state, lua_upvalueindex(1)), lua_upvalueindex(2), 2);
}

void take(lua_State* state, int to, int from, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_getfield(state, from, name);
    lua_setfield(state, to, name);
  }
}

// [-0 +0] Puts a read-only library of these functions into the table at `globals`; extend(state) may change the copy,
// which is at the top.
void add_library(lua_State* state, int globals, const char* name, std::initializer_list<const char*> names,
                 auto extend) {
  lua_newtable(state);
  const int copy = lua_gettop(state);
  lua_getglobal(state, name);
  take(state, copy, copy + 1, names);
  lua_pop(state, 1);
  extend(state);
  make_read_only(state, name);
  lua_setfield(state, globals, name);
}

void open_libraries(lua_State* state) {
  const luaL_Reg libraries[] = {{"", luaopen_base},
                                {LUA_STRLIBNAME, luaopen_string},
                                {LUA_TABLIBNAME, luaopen_table},
                                {LUA_MATHLIBNAME, luaopen_math},
                                {LUA_BITLIBNAME, luaopen_bit}};
  for (const luaL_Reg& library : libraries) {
    lua_pushcfunction(state, library.func);
    lua_pushstring(state, library.name);
    lua_call(state, 1, 0);
  }
}

void guard_string_metatable(lua_State* state, int globals) {
  lua_pushliteral(state, "");
  lua_getmetatable(state, -1);
  lua_getfield(state, globals, "string");
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 2);
}

// Content at the top that is filled when it is read is read.
void fill(lua_State* state) {
  if (lua_getmetatable(state, -1) == 0) return;
  lua_pushlightuserdata(state, const_cast<char*>(&filler_key));
  lua_rawget(state, -2);
  if (lua_isfunction(state, -1)) {
    lua_pushboolean(state, 1);
    lua_call(state, 1, 0);
    return lua_pop(state, 1);
  }
  lua_pop(state, 2);
}

const char loading_marker = 0;

enum class Found { nowhere, broken, loaded };

// [-0 +1] The module's function, or the message when it is broken. Lua may raise through this for want of memory alone.
Found push_module(lua_State* state, const char* name) {
  LuaState& owner = *core_of(state).owner;
  const std::filesystem::path path = owner.find_module(name);
  if (path.empty()) return Found::nowhere;
  return owner.load_file(state, path) ? Found::loaded : Found::broken;
}

}  // namespace

int raise_unknown_field(lua_State* state, const char* name, int content, int key) {
  lua_pushvalue(state, content);
  const int copy = lua_gettop(state);
  lua_pushvalue(state, key);
  char shown[160];
  const char* text = lua_tostring(state, -1);
  std::snprintf(shown, sizeof shown, "%s", text != nullptr ? text : luaL_typename(state, key));
  const std::string_view foreign = *name == '\0' ? foreign_name_hint(shown) : foreign_field_hint(name, shown);
  if (*name == '\0') {
    const ScriptPlace place = calling_place(state);
    core_of(state).budget.charge(state, core_of(state).owner->search_instructions(place.chunk));
    const std::string_view unquoted =
        unquoted_value_key(core_of(state).owner->line_text(place.chunk, place.line), shown);
    if (!unquoted.empty())
      return luaL_error(state, "unknown name '%s': a name is a text: %s = \"%s\"", shown, unquoted.data(), shown);
    if (!foreign.empty()) return luaL_error(state, "unknown name '%s'%s", shown, foreign.data());
  }
  const Hint hint = make_hint(state, shown, [&](auto& names) {
    for (lua_pushnil(state); lua_next(state, copy) != 0; lua_pop(state, 1)) {
      if (lua_type(state, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(state, -2));
    }
  });
  if (*name == '\0') return luaL_error(state, "unknown name '%s'%s", shown, hint.data());
  if (!foreign.empty()) return luaL_error(state, "%s has no '%s'%s", name, shown, foreign.data());
  return luaL_error(state, "%s has no '%s'%s", name, shown, hint.data());
}

void make_read_only(lua_State* state, const char* name, bool strict) {
  const int content = lua_gettop(state);
  if (strict) {
    lua_createtable(state, 0, 1);
    lua_pushstring(state, name);
    lua_pushvalue(state, content);
    lua_pushcclosure(state, refuse_read, 2);
    lua_setfield(state, -2, "__index");
    lua_setmetatable(state, content);
  }
  core_of(state).heap.for_ticks(true);
  lua_newtable(state);
  lua_createtable(state, 0, 4);
  core_of(state).heap.for_ticks(false);
  lua_pushvalue(state, content);
  lua_setfield(state, -2, "__index");
  lua_pushstring(state, name);
  lua_pushcclosure(state, refuse_write, 1);
  lua_setfield(state, -2, "__newindex");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_pushlightuserdata(state, const_cast<char*>(&content_key));
  lua_pushvalue(state, content);
  lua_rawset(state, -3);
  lua_setmetatable(state, -2);
  lua_remove(state, content);
}

bool push_content(lua_State* state, int index) {
  if (lua_getmetatable(state, index) == 0) return false;
  lua_pushlightuserdata(state, const_cast<char*>(&content_key));
  lua_rawget(state, -2);
  lua_remove(state, -2);
  if (lua_istable(state, -1)) return fill(state), true;
  lua_pop(state, 1);
  return false;
}

void set_filler(lua_State* state) {
  lua_pushlightuserdata(state, const_cast<char*>(&filler_key));
  lua_insert(state, -2);
  lua_rawset(state, -3);
}

void open_sandbox(lua_State* state) {
  core_of(state).slots.find_place(state);
  open_libraries(state);
  lua_newtable(state);
  const int globals = lua_gettop(state);
  lua_pushvalue(state, LUA_GLOBALSINDEX);
  take(state, globals, globals + 1,
       {"assert", "getmetatable", "ipairs", "rawequal", "rawget", "rawlen", "select", "setmetatable", "tonumber",
        "type", "unpack"});
  lua_pop(state, 1);
  open_base(state);
  const luaL_Reg functions[] = {{"pairs", sandbox_pairs}, {"require", sandbox_require}};
  set_functions(state, functions);

  add_library(state, globals, "coroutine", {"create", "resume", "running", "status", "wrap", "yield"},
              [globals](lua_State* lua) { open_protected_calls(lua, globals); });
  add_library(
      state, globals, "string",
      {"byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "rep", "reverse", "sub", "upper"},
      open_strings);
  guard_string_metatable(state, globals);
  add_library(state, globals, "table", {"concat", "insert", "maxn", "remove", "sort"}, open_tables);
  add_library(state, globals, "math", {"abs",  "acos",  "asin",  "atan", "atan2", "ceil", "cos",   "cosh", "deg",
                                       "exp",  "floor", "frexp", "huge", "ldexp", "log",  "log10", "max",  "min",
                                       "modf", "pi",    "pow",   "rad",  "sin",   "sinh", "sqrt",  "tan",  "tanh"},
              open_math);
  add_library(state, globals, "bit",
              {"arshift", "band", "bnot", "bor", "bswap", "bxor", "lshift", "rol", "ror", "rshift", "tobit", "tohex"},
              [](lua_State*) {});
  lua_pushliteral(state, "Lua 5.1");
  lua_setfield(state, globals, "_VERSION");

  lua_newtable(state);  // modules that are loaded, for require
  open_kadans_module(state);
  lua_setfield(state, -2, "kadans");
  lua_setfield(state, LUA_REGISTRYINDEX, "kadans.modules");

  lua_pushvalue(state, globals);
  make_read_only(state, "");
  lua_pushvalue(state, -1);
  lua_setfield(state, globals, "_G");
  lua_pushlightuserdata(state, const_cast<char*>(&environment_key));
  lua_insert(state, -2);
  lua_rawset(state, LUA_REGISTRYINDEX);
}

void push_environment(lua_State* state) {
  lua_pushlightuserdata(state, const_cast<char*>(&environment_key));
  lua_rawget(state, LUA_REGISTRYINDEX);
}

// There is no such module; the hint is one of the files that could have been meant.
int refuse_module(lua_State* state, const char* name) {
  const Hint hint = make_hint(state, name, [&](auto& names) {
    names = core_of(state).owner->module_names();
    names.emplace_back("kadans");
  });
  return luaL_error(state, "no module '%s': it is neither \"kadans\", nor beside this script, nor in behaviors/lib%s",
                    name, std::strncmp(hint.data(), ", did", 5) == 0 ? hint.data() : "");
}

int sandbox_require(lua_State* state) {
  const char* name = luaL_checkstring(state, 1);
  lua_settop(state, 1);
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, 2, name);
  if (lua_touserdata(state, 3) == &loading_marker) return luaL_error(state, "module '%s' requires itself", name);
  if (!lua_isnil(state, 3)) return 1;
  lua_pop(state, 1);
  if (!core_of(state).loading) return luaL_error(state, "require '%s' belongs at the top of the file", name);
  switch (push_module(state, name)) {
    case Found::nowhere:
      return refuse_module(state, name);
    case Found::broken:
      return lua_error(state);
    case Found::loaded:
      break;
  }
  lua_pushlightuserdata(state, const_cast<char*>(&loading_marker));
  lua_setfield(state, 2, name);
  lua_call(state, 0, 1);
  if (lua_isnil(state, -1)) {
    lua_pop(state, 1);
    lua_pushboolean(state, 1);
  }
  lua_pushvalue(state, -1);
  lua_setfield(state, 2, name);
  return 1;
}

}  // namespace kadans
