// require(name): "kadans", a file in the script's own folder, or one in behaviors/lib; each loaded once a state.
#include <filesystem>

#include "sandbox.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"

namespace kadans {
namespace {

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
      return luaL_error(state, "no module '%s': it is neither \"kadans\", nor beside this script, nor in behaviors/lib",
                        name);
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
