// The base library of the sandbox, and what of math is not Lua's own.
#include <cmath>
#include <cstdint>

#include "handle.h"
#include "sandbox.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"

namespace kadans {
namespace {

constexpr double number_text_instructions = 150, line_instructions = 1000, caught_instructions = 400;
constexpr int depths_apart = 256;   // two counts in one number
constexpr int coroutines_max = 20;  // each names its place in an error that passes

// settle(depth, ok, ...): what pcall and coroutine.resume return, unless the budget is gone. An error may have passed
// through library functions that count their depth; its message may have taken a look through its whole function.
int settle(lua_State* state) {
  LuaCore& core = core_of(state);
  core.budget.raise_again(state);
  const auto depths = static_cast<int>(lua_tointeger(state, 1));
  core.depth = depths % depths_apart;
  core.coroutines = depths / depths_apart;
  if (lua_toboolean(state, 2) == 0) {
    core.budget.charge(state, caught_instructions);
    core.budget.charge_scan(state);
  }
  return lua_gettop(state) - 1;
}
int depth(lua_State* state) {
  const LuaCore& core = core_of(state);
  return lua_pushinteger(state, core.depth + depths_apart * core.coroutines), 1;
}
// The same, for a coroutine that is about to be resumed: an error passes those around it one by one.
int enter_coroutine(lua_State* state) {
  const int depths = depth(state);
  LuaCore& core = core_of(state);
  if (core.coroutines >= coroutines_max) {
    lua_pushliteral(state, "coroutines resume one another too deeply");
    return lua_error(state);  // a place would be in the prelude
  }
  ++core.coroutines;
  return depths;
}

// [-0 +1] A value without a __tostring as text; without addresses, which differ from run to run.
void push_text(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER:
      core_of(state).budget.charge(state, number_text_instructions);
      [[fallthrough]];
    case LUA_TSTRING:
      lua_pushvalue(state, index);
      lua_tostring(state, -1);
      return;
    case LUA_TBOOLEAN:
      return lua_pushstring(state, lua_toboolean(state, index) != 0 ? "true" : "false");
    default:
      return lua_pushstring(state, luaL_typename(state, index));
  }
}

// print(...): one line to the log.
int print(lua_State* state) {
  const int count = lua_gettop(state);
  LuaCore& core = core_of(state);
  core.budget.charge(state, line_instructions);
  begin_callback(state, "print");
  luaL_Buffer buffer;
  luaL_buffinit(state, &buffer);
  for (int i = 1; i <= count; ++i) {
    if (i > 1) luaL_addlstring(&buffer, " ", 1);
    if (luaL_callmeta(state, i, "__tostring") == 0) push_text(state, i);
    charge_text(state, static_cast<double>(lua_objlen(state, -1)));
    luaL_addvalue(&buffer);
  }
  luaL_pushresult(&buffer);
  end_callback(state);
  ScriptVoice* voice = core.owner->settings().voice;
  if (voice != nullptr) voice->say_with(BehaviorLog::Severity::info, lua_tostring(state, -1));
  return 0;
}

// tostring(value)
int to_string(lua_State* state) {
  luaL_checkany(state, 1);
  begin_callback(state, "tostring");
  const bool own = luaL_callmeta(state, 1, "__tostring") != 0;
  end_callback(state);
  if (!own) push_text(state, 1);
  return 1;
}

// load(text [, name]) -> function | nil, message. Text only, in the sandbox. LuaJIT looks for each name through all
// locals around it and goes along all that `and` joins, so the time may grow with the square of the length.
int load(lua_State* state) {
  constexpr double square_of_an_instruction = 128;
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, 1, &length);
  const char* name = luaL_optstring(state, 2, "load");
  const auto bytes = static_cast<double>(length);
  core_of(state).budget.charge(state, compiling_instructions(bytes) + bytes * bytes / square_of_an_instruction);
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
  const bool text = lua_type(state, 1) == LUA_TSTRING;
  core_of(state).budget.charge(state, text ? static_cast<double>(lua_objlen(state, 1)) / 2 : 0);
  return forward(state);
}

// error(message [, level]): as in Lua. The level is looked for along the stack.
int raise(lua_State* state) {
  const int level = luaL_optint(state, 2, 1);
  lua_settop(state, 1);
  if (lua_isstring(state, 1) != 0 && level > 0) {
    if (level > 2) core_of(state).budget.charge_scan(state);
    luaL_where(state, level);
    lua_pushvalue(state, 1);
    lua_concat(state, 2);
  }
  return lua_error(state);
}

// fmod(a, b): as in Lua; divides bit by bit.
int remainder(lua_State* state) {
  const double a = luaL_checknumber(state, 1), b = luaL_checknumber(state, 2);
  const int bits = a != 0 && b != 0 && std::isfinite(a) && std::isfinite(b) ? std::ilogb(a) - std::ilogb(b) : 0;
  core_of(state).budget.charge(state, bits / 4.0);
  return lua_pushnumber(state, std::fmod(a, b)), 1;
}

// unpack(table [, i [, j]]): as in Lua.
int unpack(lua_State* state) {
  const int results = forward(state);
  core_of(state).budget.charge(state, 0.6 * results);
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
local settle, depth, enter_coroutine, raw_pcall, raw_resume, create, error = ...
local function pcall(f, ...) return settle(depth(), raw_pcall(f, ...)) end
local function handled(handler, ok, ...)
  if ok then return ok, ... end
  return false, handler(...)
end
local function xpcall(f, handler, ...) return handled(handler, pcall(f, ...)) end
local function resume(thread, ...) return settle(enter_coroutine(), raw_resume(thread, ...)) end
local function result(ok, ...)
  if ok then return ... end
  error((...), 2)
end
local function wrap(f)
  local thread = create(f)
  return function(...) return result(settle(enter_coroutine(), raw_resume(thread, ...))) end
end
return pcall, xpcall, resume, wrap
)";

}  // namespace

void open_base(lua_State* state) {
  const luaL_Reg functions[] = {
      {"print", print}, {"tostring", to_string}, {"error", raise}, {"load", load}, {"rawset", raw_set}};
  wrap(state, "tonumber", to_number);
  wrap(state, "unpack", unpack);
  set_functions(state, functions);
}

void open_math(lua_State* state) {
  const luaL_Reg functions[] = {{"random", random}, {"fmod", remainder}};
  set_functions(state, functions);
}

void open_protected_calls(lua_State* state, int globals) {
  const int coroutines = lua_gettop(state);
  if (luaL_loadbuffer(state, prelude, sizeof prelude - 1, "=kadans") != 0) lua_error(state);
  lua_pushcfunction(state, settle);
  lua_pushcfunction(state, depth);
  lua_pushcfunction(state, enter_coroutine);
  lua_getglobal(state, "pcall");
  lua_getfield(state, coroutines, "resume");
  lua_getfield(state, coroutines, "create");
  lua_pushcfunction(state, raise);
  lua_call(state, 7, 4);
  lua_setfield(state, coroutines, "wrap");
  lua_setfield(state, coroutines, "resume");
  lua_setfield(state, globals, "xpcall");
  lua_setfield(state, globals, "pcall");
}

}  // namespace kadans
