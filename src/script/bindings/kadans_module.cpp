// The table that require "kadans" returns.
#include "bindings.h"
#include "script/chart/chart_nodes.h"
#include "script/check/hint.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

constexpr double joint_instructions = 20;

// budget() -> { instructions =, memory_bytes = }: what is left.
int budget(lua_State* state) {
  const LuaCore& core = core_of(state);
  lua_createtable(state, 0, 2);
  lua_pushnumber(state, static_cast<lua_Number>(core.budget.left()));
  lua_setfield(state, -2, "instructions");
  const std::size_t used = core.heap.used_bytes(), limit = core.heap.limit_bytes();
  lua_pushnumber(state, static_cast<lua_Number>(used < limit ? limit - used : 0));
  lua_setfield(state, -2, "memory_bytes");
  return 1;
}

// pose(name) -> { joint = position in rad }: a copy of a pose in the robot's configuration.
int pose(lua_State* state) {
  const char* name = luaL_checkstring(state, 1);
  if (core_of(state).bindings == nullptr) return luaL_error(state, "no robot here has poses");
  const Catalog& catalog = *bindings_of(state).catalog;
  for (const PoseInfo& known : catalog.poses) {
    if (known.name != name) continue;
    core_of(state).budget.charge(state, joint_instructions * static_cast<double>(known.position_rad.size()));
    lua_newtable(state);
    for (const auto& [joint, position_rad] : known.position_rad) {
      lua_pushnumber(state, position_rad);
      lua_setfield(state, -2, catalog.model->joints[joint].name.c_str());
    }
    return 1;
  }
  const Hint hint = make_hint(state, name, [&](auto& names) { names = names_of(catalog.poses); });
  return luaL_error(state, "unknown pose '%s'%s", name, hint.data());
}

}  // namespace

void open_kadans_module(lua_State* state) {
  lua_newtable(state);
  open_parameters(state);
  open_nodes(state);
  lua_pushcfunction(state, budget);
  lua_setfield(state, -2, "budget");
  lua_pushcfunction(state, pose);
  lua_setfield(state, -2, "pose");
  open_log(state);
  make_read_only(state, "kadans");
}

}  // namespace kadans
