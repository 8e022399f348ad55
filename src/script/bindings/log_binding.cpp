// k.log: lines for people, in the record and on the console, each with its severity.
#include "bindings.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr double charge_instructions = 1000;  // as for print

// log.info(format [, ...]): the format of string.format when there is more than one argument. Upvalue: severity.
int log_line(lua_State* state) {
  if (lua_type(state, 1) != LUA_TSTRING)
    return luaL_error(state, "log needs a text: log.info(\"height %%.2f m\", s.base.height_m)");
  const int count = lua_gettop(state);
  if (count > 1) {
    push_environment(state);
    lua_getfield(state, -1, "string");
    lua_getfield(state, -1, "format");
    lua_insert(state, 1);
    lua_settop(state, count + 1);
    lua_call(state, count, 1);
  }
  LuaCore& core = core_of(state);
  core.budget.charge(state, charge_instructions);
  const auto severity = static_cast<BehaviorLog::Severity>(lua_tointeger(state, lua_upvalueindex(1)));
  ScriptVoice* voice = core.owner->settings().voice;
  if (voice != nullptr) voice->say_with(severity, lua_tostring(state, 1));
  return 0;
}

}  // namespace

void open_log(lua_State* state) {
  constexpr const char* names[] = {"info", "warning", "error"};  // as BehaviorLog::Severity
  lua_createtable(state, 0, 3);
  for (int i = 0; i < 3; ++i) {
    lua_pushinteger(state, i);
    lua_pushcclosure(state, log_line, 1);
    lua_setfield(state, -2, names[i]);
  }
  make_read_only(state, "kadans.log");
  lua_setfield(state, -2, "log");
}

}  // namespace kadans
