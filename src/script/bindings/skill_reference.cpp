// The chapter of the reference about the skills of the project's library.
#include <algorithm>
#include <cmath>
#include <map>

#include <lua.hpp>

#include "api.h"
#include "script/chart/chart_arguments.h"
#include "script/chart/chart_skills.h"
#include "script/lua/lua_state.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

std::string default_text(const ScriptArgument& argument) {
  if (!argument.initial) return "a table";
  if (const auto* number = std::get_if<double>(&*argument.initial)) return number_text(*number);
  if (const auto* flag = std::get_if<bool>(&*argument.initial)) return *flag ? "true" : "false";
  return "\"" + std::get<std::string>(*argument.initial) + "\"";
}

// "0.1..10 s", "\"left\", \"right\"".
std::string allowed_text(const ScriptArgument& argument) {
  const auto end = [](double value) { return std::isfinite(value) ? number_text(value) : ""; };
  std::string text = end(argument.min) + ".." + end(argument.max);
  if (text == "..") text.clear();
  if (!argument.unit.empty()) text += (text.empty() ? "" : " ") + argument.unit;
  for (const std::string& choice : argument.one_of) text += (text.empty() ? "\"" : ", \"") + choice + "\"";
  return text;
}

// Of the skill whose table is at `skill`.
std::string skill_text(lua_State* state, int skill) {
  std::string text = text_of_field(state, skill, "doc") + ".\n";
  lua_getfield(state, skill, "args");
  const int declared = lua_gettop(state);
  const std::vector<ScriptArgument> arguments = read_declarations(state, declared);
  lua_pop(state, 1);
  if (!arguments.empty()) text += "\n| argument | default | allowed | |\n|---|---|---|---|\n";
  for (const ScriptArgument& argument : arguments) {
    text += "| `" + argument.name + "` | " + default_text(argument) + " | " + allowed_text(argument) + " | " +
            argument.doc + " |\n";
  }
  return text;
}

// By field, as Markdown. Nothing here raises but the module, before a string is made.
void read_skills(lua_State* state, LuaState& lua, const std::filesystem::path& file,
                 std::map<std::string, std::string>& skills) {
  if (!lua.load_file(state, file)) lua_error(state);
  lua_call(state, 0, 1);
  const int module = lua_gettop(state);
  luaL_checkstack(state, 16, "skills");
  if (!lua_istable(state, module)) return;
  for (lua_pushnil(state); lua_next(state, module) != 0; lua_settop(state, module + 1)) {
    if (lua_type(state, module + 1) != LUA_TSTRING || !push_skill(state, module + 2)) continue;
    skills[lua_tostring(state, module + 1)] = skill_text(state, lua_gettop(state));
  }
}

std::string module_reference(const std::filesystem::path& root, const std::filesystem::path& file) {
  LuaState lua({.root = root, .folder = file.parent_path(), .name = file.stem().string()});
  std::map<std::string, std::string> skills;
  lua.call_or_throw([&](lua_State* state) { read_skills(state, lua, file, skills); },
                    lua.settings().limits.load_instructions, 0);
  const std::string module = file.stem().string();
  std::string text;
  for (const auto& [field, skill] : skills) {
    text += "\n### `" + module + "." + field + "`\n\n" + skill;
  }
  return text;
}

}  // namespace

std::string skill_reference(const std::filesystem::path& root) {
  const std::filesystem::path folder = root / "behaviors/lib";
  std::error_code none;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".lua") && !name.ends_with("_test.lua")) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::string text;
  for (const std::filesystem::path& file : files) text += module_reference(root, file);
  if (text.empty()) return "";
  return "\n## Skills of behaviors/lib: `MODULE.SKILL \"state\" { argument = value, transitions }`\n" + text;
}

}  // namespace kadans
