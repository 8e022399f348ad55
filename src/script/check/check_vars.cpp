#include "check_vars.h"

#include "kadans/signal/input_error.h"
#include "script/behavior/vars_transfer.h"
#include "script/chart/chart_nodes.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

struct Looking {
  Behavior::Parts& parts;
  std::vector<InputProblem>& problems;
  std::string chunk{};
  int line = 0;  // where the table is declared, or after it
};

void tell(Looking& looking, const std::string& path, const std::string& key, const std::string& what) {
  const int line = looking.parts.lua->line_of(looking.chunk, looking.line, key);
  looking.problems.push_back({looking.chunk, line, 0, path + what + ": vars and args hold plain data"});
}

// [-0 +0] The value at the top. Nothing here raises but for want of memory.
void look_into(lua_State* state, Looking& looking, const std::string& path, const std::string& key, int depth) {
  const int type = lua_type(state, -1);
  std::size_t number = 0;
  if (is_parameter(state, lua_gettop(state), &number))
    return tell(looking, path, key, " is a parameter, which is read where it is needed");
  if (type == LUA_TFUNCTION || type == LUA_TUSERDATA || type == LUA_TTHREAD)
    return tell(looking, path, key, std::string(" is a ") + lua_typename(state, type));
  if (type != LUA_TTABLE) return;
  if (depth > vars_depth_max) return tell(looking, path, key, " is nested too deeply, or holds itself");
  luaL_checkstack(state, 6, "vars");
  const int table = lua_gettop(state);
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) {
    const std::string name = lua_type(state, -2) == LUA_TSTRING   ? lua_tostring(state, -2)
                             : lua_type(state, -2) == LUA_TNUMBER ? std::to_string(lua_tointeger(state, -2))
                                                                  : "?";
    const std::size_t known = looking.problems.size();
    look_into(state, looking, path + "." + name, name, depth + 1);
    if (depth > 1 && looking.problems.size() > known) break;  // one of a nested table: it may hold itself
  }
  lua_settop(state, table);
}

void look_at(lua_State* state, Looking& looking, int reference, const char* name) {
  if (reference == Chart::no_function) return;
  lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
  look_into(state, looking, name, name, 0);
  lua_pop(state, 1);
}

int look(lua_State* state) {
  auto& looking = *static_cast<Looking*>(lua_touserdata(state, 1));
  const Chart& chart = looking.parts.chart;
  for (const Chart::Machine& machine : chart.machines) {
    looking.chunk = chart.states[machine.root].chunk;
    looking.line = chart.states[machine.root].line;
    look_at(state, looking, machine.vars, "vars");
    look_at(state, looking, machine.arguments, "args");
    looking.chunk = machine.call_chunk;
    looking.line = machine.call_line;
    if (!machine.call_chunk.empty()) look_at(state, looking, machine.given, "args");
  }
  return 0;
}

}  // namespace

void check_vars(Behavior::Parts& parts, std::vector<InputProblem>& problems) {
  Looking looking{parts, problems};
  if (parts.lua->call(look, &looking, parts.settings.limits.load_instructions, 0)) return;
  const ScriptError& error = parts.lua->error();
  throw InputError({error.file.data(), error.line, 0, error.message.data()});
}

}  // namespace kadans
