#include "sandbox.h"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "hint.h"
#include "kadans/script/lua_state.h"
#include "library_function.h"
#include "lua_core.h"

namespace kadans {
namespace {

const char environment_key = 0;
const char content_key = 0;
const char filler_key = 0;

// The message is made here, so that nothing that needs a destructor is alive when Lua raises.
void describe_unknown(lua_State* state, const char* name, int content, const char* key, char* text,
                      std::size_t size) noexcept {
  std::vector<std::string> names;
  for (lua_pushnil(state); lua_next(state, content) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) == LUA_TSTRING) names.emplace_back(lua_tostring(state, -2));
  }
  std::sort(names.begin(), names.end());
  const std::string hint = hint_text(key, names);
  std::snprintf(text, size, *name == '\0' ? "%sunknown name '%s'%s" : "%s has no '%s'%s", name, key, hint.c_str());
}

int refuse_write(lua_State* state) {  // (proxy, key, value); upvalue: name
  const char* name = lua_tostring(state, lua_upvalueindex(1));
  const char* key = lua_type(state, 2) == LUA_TSTRING ? lua_tostring(state, 2) : "?";
  if (*name == '\0') return luaL_error(state, "'%s' would be a global: write local %s", key, key);
  return luaL_error(state, "%s is read-only: '%s' cannot be set", name, key);
}

int refuse_read(lua_State* state) {  // (content, key); upvalues: name, content
  return raise_unknown_field(state, lua_tostring(state, lua_upvalueindex(1)), lua_upvalueindex(2), 2);
}

// settle(depth, ok, ...): what pcall and coroutine.resume return, unless the budget is gone. An error may have passed
// through library functions that count their depth.
int settle(lua_State* state) {
  LuaCore& core = core_of(state);
  core.budget.raise_again(state);
  core.depth = static_cast<int>(lua_tointeger(state, 1));
  return lua_gettop(state) - 1;
}
int depth(lua_State* state) { return lua_pushinteger(state, core_of(state).depth), 1; }

// print(...): one line to the log.
int print(lua_State* state) {
  const int count = lua_gettop(state);
  begin_callback(state, "print");
  luaL_Buffer buffer;
  luaL_buffinit(state, &buffer);
  for (int i = 1; i <= count; ++i) {
    if (i > 1) luaL_addlstring(&buffer, " ", 1);
    if (luaL_callmeta(state, i, "__tostring") == 0) {
      if (lua_isstring(state, i) != 0) {
        lua_pushvalue(state, i);
      } else if (lua_isnil(state, i) || lua_isboolean(state, i)) {
        lua_pushstring(state, lua_isnil(state, i) ? "nil" : lua_toboolean(state, i) != 0 ? "true" : "false");
      } else {
        lua_pushstring(state, luaL_typename(state, i));  // no addresses: they differ from run to run
      }
    }
    luaL_addvalue(&buffer);
  }
  luaL_pushresult(&buffer);
  end_callback(state);
  LuaCore& core = core_of(state);
  core.budget.charge(state, 1000.0);
  ScriptVoice* voice = core.owner->settings().voice;
  if (voice != nullptr) voice->say(lua_tostring(state, -1));
  return 0;
}

// tostring(value): without addresses, which differ from run to run.
int to_string(lua_State* state) {
  luaL_checkany(state, 1);
  begin_callback(state, "tostring");
  const bool own = luaL_callmeta(state, 1, "__tostring") != 0;
  end_callback(state);
  if (own) return 1;
  switch (lua_type(state, 1)) {
    case LUA_TNUMBER:
    case LUA_TSTRING:
      lua_pushvalue(state, 1);
      lua_tostring(state, -1);
      return 1;
    case LUA_TBOOLEAN:
      lua_pushstring(state, lua_toboolean(state, 1) != 0 ? "true" : "false");
      return 1;
    default:
      lua_pushstring(state, luaL_typename(state, 1));
      return 1;
  }
}

// load(text [, name]) -> function | nil, message. Text only, in the sandbox.
int load(lua_State* state) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, 1, &length);
  const char* name = luaL_optstring(state, 2, "load");
  core_of(state).budget.charge(state, static_cast<double>(length));
  lua_pushfstring(state, "=%s", name);
  if (luaL_loadbufferx(state, text, length, lua_tostring(state, -1), "t") != 0) {
    lua_pushnil(state);
    lua_insert(state, -2);
    return 2;
  }
  push_environment(state);
  lua_setfenv(state, -2);
  return 1;
}

// tonumber(value [, base]): as in Lua.
int to_number(lua_State* state) {
  if (lua_type(state, 1) == LUA_TSTRING) charge_text(state, static_cast<double>(lua_objlen(state, 1)));
  return forward(state);
}

// unpack(table [, i [, j]]): as in Lua.
int unpack(lua_State* state) {
  const int results = forward(state);
  core_of(state).budget.charge(state, results / 8.0);
  return results;
}

// rawset(table, key, value): not on what is read-only.
int raw_set(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  luaL_checkany(state, 3);
  if (push_content(state, 1)) return luaL_error(state, "this table is read-only");
  lua_settop(state, 3);
  lua_rawset(state, 1);
  return 1;
}

// random() in [0, 1), random(m) in 1..m, random(m, n) in m..n; from the run's seed.
int random(lua_State* state) {
  RandomStream& stream = core_of(state).random;
  if (lua_gettop(state) == 0) return lua_pushnumber(state, stream.uniform()), 1;
  const lua_Number first = lua_gettop(state) > 1 ? luaL_checknumber(state, 1) : 1;
  const lua_Number last = luaL_checknumber(state, lua_gettop(state) > 1 ? 2 : 1);
  if (!(first <= last && last - first < 9007199254740992.0)) return luaL_argerror(state, 1, "the interval is empty");
  const auto span = static_cast<std::uint64_t>(last - first) + 1;
  lua_pushnumber(state, first + static_cast<lua_Number>(stream.next() % span));
  return 1;
}

// In Lua, so that coroutines may yield through pcall. A handler of xpcall runs after the stack has unwound: inside the
// raising it could not be stopped.
const char prelude[] = R"(
local settle, depth, raw_pcall, raw_resume = ...
local function pcall(f, ...) return settle(depth(), raw_pcall(f, ...)) end
local function handled(handler, ok, ...)
  if ok then return ok, ... end
  return false, handler(...)
end
local function xpcall(f, handler, ...) return handled(handler, pcall(f, ...)) end
local function resume(thread, ...) return settle(depth(), raw_resume(thread, ...)) end
return pcall, xpcall, resume
)";

void take(lua_State* state, int to, int from, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    lua_getfield(state, from, name);
    lua_setfield(state, to, name);
  }
}

void set_function(lua_State* state, int table, const char* name, lua_CFunction function) {
  lua_pushcfunction(state, function);
  lua_setfield(state, table, name);
}

// [-0 +1] A read-only library of these functions; `extend` may change the copy.
void push_library(lua_State* state, const char* name, std::initializer_list<const char*> names,
                  void (*extend)(lua_State*)) {
  lua_newtable(state);
  const int copy = lua_gettop(state);
  lua_getglobal(state, name);
  take(state, copy, copy + 1, names);
  lua_pop(state, 1);
  if (extend != nullptr) extend(state);
}

void extend_math(lua_State* state) { set_function(state, lua_gettop(state), "random", random); }

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

// pcall, xpcall into the globals at `globals`, resume into the coroutine library at the top.
void add_protected_calls(lua_State* state, int globals) {
  const int coroutines = lua_gettop(state);
  if (luaL_loadbuffer(state, prelude, sizeof prelude - 1, "=kadans") != 0) lua_error(state);
  lua_pushcfunction(state, settle);
  lua_pushcfunction(state, depth);
  lua_getglobal(state, "pcall");
  lua_getfield(state, coroutines, "resume");
  lua_call(state, 4, 3);
  lua_setfield(state, coroutines, "resume");
  lua_setfield(state, globals, "xpcall");
  lua_setfield(state, globals, "pcall");
}

void guard_string_metatable(lua_State* state, int strings) {
  lua_pushliteral(state, "");
  lua_getmetatable(state, -1);
  lua_pushvalue(state, strings);
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

}  // namespace

int raise_unknown_field(lua_State* state, const char* name, int content, int key) {
  char text[256];
  lua_pushvalue(state, content);
  const int copy = lua_gettop(state);
  lua_pushvalue(state, key);
  const char* shown = lua_tostring(state, -1);
  describe_unknown(state, name, copy, shown != nullptr ? shown : luaL_typename(state, key), text, sizeof text);
  return luaL_error(state, "%s", text);
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
  open_libraries(state);
  lua_newtable(state);
  const int globals = lua_gettop(state);
  lua_pushvalue(state, LUA_GLOBALSINDEX);
  take(state, globals, globals + 1,
       {"assert", "error", "getmetatable", "ipairs", "rawequal", "rawget", "rawlen", "select", "setmetatable",
        "tonumber", "type", "unpack"});
  lua_pop(state, 1);
  wrap(state, "tonumber", to_number);
  wrap(state, "unpack", unpack);
  set_function(state, globals, "print", print);
  set_function(state, globals, "tostring", to_string);
  set_function(state, globals, "load", load);
  set_function(state, globals, "rawset", raw_set);
  set_function(state, globals, "pairs", sandbox_pairs);
  set_function(state, globals, "require", sandbox_require);

  push_library(state, "coroutine", {"create", "resume", "running", "status", "wrap", "yield"}, nullptr);
  add_protected_calls(state, globals);
  make_read_only(state, "coroutine");
  lua_setfield(state, globals, "coroutine");
  push_library(
      state, "string",
      {"byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "rep", "reverse", "sub", "upper"},
      open_strings);
  make_read_only(state, "string");
  guard_string_metatable(state, lua_gettop(state));
  lua_setfield(state, globals, "string");
  push_library(state, "table", {"concat", "insert", "maxn", "remove", "sort"}, open_tables);
  make_read_only(state, "table");
  lua_setfield(state, globals, "table");
  push_library(state, "math", {"abs",   "acos", "asin",  "atan", "atan2", "ceil", "cos",   "cosh", "deg", "exp",
                               "floor", "fmod", "frexp", "huge", "ldexp", "log",  "log10", "max",  "min", "modf",
                               "pi",    "pow",  "rad",   "sin",  "sinh",  "sqrt", "tan",   "tanh"},
               extend_math);
  make_read_only(state, "math");
  lua_setfield(state, globals, "math");
  push_library(state, "bit",
               {"arshift", "band", "bnot", "bor", "bswap", "bxor", "lshift", "rol", "ror", "rshift", "tobit", "tohex"},
               nullptr);
  make_read_only(state, "bit");
  lua_setfield(state, globals, "bit");
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

}  // namespace kadans
