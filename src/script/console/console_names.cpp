// What a line on the console sees, and the names in it.
#include <algorithm>
#include <numeric>

#include "console_parts.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

// Values as text: tables with their fields in order, numbers without noise.
constexpr const char* show_text = R"(
local function show(value, depth)
  local kind = type(value)
  if kind == "number" then return string.format("%.10g", value) end
  if kind == "string" then return depth > 0 and string.format("%q", value) or value end
  if kind ~= "table" then return tostring(value) end
  if depth >= 3 then return "{ ... }" end
  local parts = {}
  for key, field in pairs(value) do
    if #parts >= 100 then parts[#parts + 1] = "..." break end
    local name = type(key) == "string" and key .. " = " or type(key) ~= "number" and tostring(key) .. " = " or ""
    parts[#parts + 1] = name .. show(field, depth + 1)
  end
  if #parts == 0 then return "{}" end
  return "{ " .. table.concat(parts, ", ") .. " }"
end
return function(...)
  local texts = {}
  for i = 1, select("#", ...) do texts[i] = show((select(i, ...)), 0) end
  return table.concat(texts, "  ")
end
)";

// A name of the globals that no line has set; upvalue 1: the content, 2: the parts.
int look_up(lua_State* state) {
  const auto& parts = *static_cast<const Console::Parts*>(lua_touserdata(state, lua_upvalueindex(2)));
  lua_settop(state, 2);
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(1));
  if (lua_isnil(state, 3)) return raise_unknown_field(state, "", lua_upvalueindex(1), 2);
  const bool machine = lua_type(state, 2) == LUA_TSTRING && std::string_view(lua_tostring(state, 2)) == "m";
  if (machine && !parts.writes) return luaL_error(state, "this console only reads: ':write' lets it command");
  return 1;
}

// [-0 +1] Registers and pushes the content: everything that is not set by lines.
void push_new_content(lua_State* state, Console::Parts& parts) {
  lua_newtable(state);
  const int content = lua_gettop(state);
  push_environment(state);
  (void)push_content(state, content + 1);
  for (lua_pushnil(state); lua_next(state, content + 2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING || std::string_view(lua_tostring(state, -2)) == "_G") continue;
    lua_pushvalue(state, -2);
    lua_pushvalue(state, -2);
    lua_rawset(state, content);
  }
  lua_settop(state, content);
  lua_getfield(state, LUA_REGISTRYINDEX, "kadans.modules");
  lua_getfield(state, -1, "kadans");
  lua_setfield(state, content, "k");
  lua_settop(state, content);
  open_machines(state, parts.chart, parts.bindings, parts.tables);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.machines[0].handle);
  lua_setfield(state, content, "m");
  parts.tables.snapshot = parts.snapshot_tables.open(state, parts.catalog, parts.settings.feet);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.tables.snapshot);
  lua_setfield(state, content, "s");
  parts.signals.push(state, "signals");
  lua_setfield(state, content, "signals");
  parts.parameters.push(state, "parameters");
  lua_setfield(state, content, "parameters");
  lua_settop(state, content);
}

// [-0 +1] { name = { state =, outcome =, error =, parameters = } }
void push_behaviors(lua_State* state, const std::vector<ConsoleBehavior>& behaviors) {
  const auto text = [&](const char* name, const std::string& value) {
    lua_pushlstring(state, value.data(), value.size());
    lua_setfield(state, -2, name);
  };
  lua_newtable(state);
  for (const ConsoleBehavior& behavior : behaviors) {
    lua_newtable(state);
    text("state", behavior.state);
    text("outcome", behavior.outcome);
    text("error", behavior.error);
    lua_newtable(state);
    for (const ScriptParameter& parameter : behavior.parameters) {
      lua_pushnumber(state, parameter.value);
      lua_setfield(state, -2, parameter.name.c_str());
    }
    make_read_only(state, "parameters");
    lua_setfield(state, -2, "parameters");
    make_read_only(state, "a behavior");
    lua_setfield(state, -2, behavior.name.c_str());
  }
  make_read_only(state, "behaviors");
}

// [-1 +1] From a value to the table that holds its fields; nil when it has none.
void to_fields(lua_State* state) {
  const int value = lua_gettop(state);
  if (lua_istable(state, value)) {
    if (push_content(state, value)) lua_remove(state, value);
    return;
  }
  if (lua_type(state, value) == LUA_TUSERDATA && lua_getmetatable(state, value) != 0) {
    lua_getfield(state, -1, "__index");
    if (lua_istable(state, -1) && push_content(state, lua_gettop(state))) {
      lua_replace(state, value);
      return lua_settop(state, value);
    }
  }
  lua_settop(state, value - 1);
  lua_pushnil(state);
}

struct Naming {
  Console::Parts& parts;
  std::vector<std::string> path{};  // before the last word
  std::string begin{};              // of the last word
  std::vector<std::string> found{};
};

// Adds the string keys of the table at the top that begin like the last word.
void add_names(lua_State* state, Naming& naming) {
  for (lua_pushnil(state); lua_next(state, -2) != 0; lua_pop(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) continue;
    const std::string_view name = lua_tostring(state, -2);
    if (name.starts_with(naming.begin)) naming.found.emplace_back(name);
  }
}

int find_names(lua_State* state) {
  Naming& naming = *static_cast<Naming*>(lua_touserdata(state, 1));
  for (const int root : {naming.parts.environment, naming.parts.content}) {
    lua_settop(state, 1);
    lua_rawgeti(state, LUA_REGISTRYINDEX, root);
    for (const std::string& part : naming.path) {
      lua_pushlstring(state, part.data(), part.size());
      lua_rawget(state, -2);
      to_fields(state);
      if (lua_isnil(state, -1)) break;
    }
    if (lua_istable(state, -1)) add_names(state, naming);
  }
  return 0;
}

}  // namespace

ValueTree::ValueTree(const std::vector<std::string>& unsorted) : ids(unsorted.size()) {
  std::iota(ids.begin(), ids.end(), std::size_t{0});
  std::ranges::sort(ids, {}, [&](std::size_t id) -> const std::string& { return unsorted[id]; });
  for (const std::size_t id : ids) names.push_back(unsorted[id]);
}

namespace {

// [-0 +1] The table of names[first..last), which agree up to `from`; slots are at `slots` on the stack.
void push_branch(lua_State* state, const ValueTree& tree, std::size_t first, std::size_t last, std::size_t from,
                 int slots, const char* title) {
  luaL_checkstack(state, 8, "names");
  lua_newtable(state);
  const int table = lua_gettop(state);
  while (first < last) {
    const std::string& name = tree.names[first];
    const std::size_t dot = std::min(name.find('.', from), name.size());
    std::size_t end = first + 1;
    while (end < last && tree.names[end].compare(from, dot + 1 - from, name, from, dot - from + 1) == 0) ++end;
    lua_pushlstring(state, name.data() + from, dot - from);
    if (dot == name.size()) {
      end = first + 1;
      lua_pushvalue(state, table);
      lua_rawseti(state, slots, static_cast<int>(2 * first + 1));
      lua_pushvalue(state, -1);
      lua_rawseti(state, slots, static_cast<int>(2 * first + 2));
      lua_pushnumber(state, 0);
    } else {
      push_branch(state, tree, first, end, dot + 1, slots, title);
    }
    lua_rawset(state, table);
    first = end;
  }
  make_read_only(state, title);
}

}  // namespace

void ValueTree::push(lua_State* state, const char* title) {
  lua_newtable(state);
  push_branch(state, *this, 0, names.size(), 0, lua_gettop(state), title);
  lua_insert(state, -2);
  slots = luaL_ref(state, LUA_REGISTRYINDEX);
}

void ValueTree::refill(lua_State* state, std::span<const double> values) const {
  const int top = lua_gettop(state);
  lua_rawgeti(state, LUA_REGISTRYINDEX, slots);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    lua_rawgeti(state, top + 1, static_cast<int>(2 * i + 1));
    lua_rawgeti(state, top + 1, static_cast<int>(2 * i + 2));
    lua_pushnumber(state, ids[i] < values.size() ? values[ids[i]] : 0);
    lua_rawset(state, top + 2);
    lua_settop(state, top + 1);
  }
  lua_settop(state, top);
}

int open_console(lua_State* state) {
  auto& parts = *static_cast<Console::Parts*>(lua_touserdata(state, 1));
  push_new_content(state, parts);
  lua_pushvalue(state, -1);
  parts.content = luaL_ref(state, LUA_REGISTRYINDEX);
  const int content = lua_gettop(state);
  lua_newtable(state);
  lua_newtable(state);
  lua_pushvalue(state, content);
  lua_pushlightuserdata(state, &parts);
  lua_pushcclosure(state, look_up, 2);
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 0);
  lua_setfield(state, -2, "__metatable");
  lua_setmetatable(state, -2);
  parts.environment = luaL_ref(state, LUA_REGISTRYINDEX);
  if (luaL_loadbuffer(state, show_text, std::char_traits<char>::length(show_text), "=show") != 0) lua_error(state);
  push_environment(state);
  lua_setfenv(state, -2);
  lua_call(state, 0, 1);
  parts.show = luaL_ref(state, LUA_REGISTRYINDEX);
  return 0;
}

void refill_console(lua_State* state, Console::Parts& parts, const Console::View& view) {
  parts.snapshot_tables.refill(state, view.snapshot, view.snapshot.time_ns);
  parts.signals.refill(state, view.signals);
  parts.parameters.refill(state, view.parameters);
  lua_rawgeti(state, LUA_REGISTRYINDEX, parts.content);
  push_behaviors(state, parts.behaviors);
  lua_setfield(state, -2, "behaviors");
  lua_pop(state, 1);
}

std::vector<std::string> console_names(Console::Parts& parts, const std::string& path) {
  Naming naming{parts};
  std::size_t from = 0;
  for (std::size_t at = path.find_first_of(".:"); at != std::string::npos; at = path.find_first_of(".:", from)) {
    naming.path.push_back(path.substr(from, at - from));
    from = at + 1;
  }
  naming.begin = path.substr(from);
  (void)parts.lua.call(find_names, &naming, parts.settings.limits.tick_instructions, 0);
  std::ranges::sort(naming.found);
  naming.found.erase(std::unique(naming.found.begin(), naming.found.end()), naming.found.end());
  for (std::string& name : naming.found) name.insert(0, path, 0, from);
  return naming.found;
}

}  // namespace kadans
