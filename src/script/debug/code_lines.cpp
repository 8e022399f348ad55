#include "code_lines.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include <lua.hpp>

#include "script/check/source_lexer.h"

namespace kadans {
namespace {

// (text, add_line, add_function): the lines of the bytecodes of all its functions. The text is compiled, nothing more.
constexpr const char* reader = R"(
local text, add_line, add_function = ...
local util = require "jit.util"
local main, why = loadstring(text, "=")
if not main then error(why, 0) end
local function read(code)
  local info, first = util.funcinfo(code), nil
  for at = 1, info.bytecodes - 1 do
    local line = util.funcinfo(code, at).currentline
    add_line(line)
    if not first or line < first then first = line end
  end
  if code ~= main then add_function(info.linedefined, info.lastlinedefined, first or 0) end
  for n = -1, -1e6, -1 do
    local constant = util.funck(code, n)
    if constant == nil then break end
    if type(constant) == "proto" then read(constant) end
  end
end
read(main)
)";

CodeLines& target(lua_State* state) { return *static_cast<CodeLines*>(lua_touserdata(state, lua_upvalueindex(1))); }

int add_line(lua_State* state) {
  target(state).lines.push_back(static_cast<int>(lua_tointeger(state, 1)));
  return 0;
}

int add_function(lua_State* state) {
  target(state).functions.push_back({.name = {},
                                     .first = static_cast<int>(lua_tointeger(state, 1)),
                                     .last = static_cast<int>(lua_tointeger(state, 2)),
                                     .code = static_cast<int>(lua_tointeger(state, 3))});
  return 0;
}

// The name beside the first `function` of the line: behind it, or before "=".
std::string name_in(std::string_view line) {
  constexpr std::string_view keyword = "function";
  const std::size_t at = line.find(keyword);
  if (at == std::string_view::npos) return "";
  std::size_t begin = std::min(line.find_first_not_of(' ', at + keyword.size()), line.size());
  std::size_t end = begin;
  while (end < line.size() && (in_name(line[end]) || line[end] == '.' || line[end] == ':')) ++end;
  if (end == begin) {
    end = line.find_last_not_of(" =", at == 0 ? 0 : at - 1);
    end = end == std::string_view::npos ? 0 : end + 1;
    begin = end;
    while (begin > 0 && in_name(line[begin - 1])) --begin;
  }
  const std::string_view name = line.substr(begin, end - begin);
  const std::size_t dot = name.find_last_of(".:");
  return std::string(dot == std::string_view::npos ? name : name.substr(dot + 1));
}

}  // namespace

int CodeLines::line_from(int line) const noexcept {
  const auto found = std::ranges::lower_bound(lines, line);
  return found == lines.end() ? 0 : *found;
}

CodeLines code_lines(const std::string& text) {
  CodeLines code;
  const std::unique_ptr<lua_State, decltype(&lua_close)> owner(luaL_newstate(), lua_close);
  lua_State* const state = owner.get();
  if (state == nullptr || text.starts_with('\x1b')) {
    code.error = state == nullptr ? "not enough memory" : "is bytecode";
    return code;
  }
  luaL_openlibs(state);
  if (luaL_loadstring(state, reader) != 0) return code;
  lua_pushlstring(state, text.data(), text.size());
  for (const lua_CFunction add : {add_line, add_function}) {
    lua_pushlightuserdata(state, &code);
    lua_pushcclosure(state, add, 1);
  }
  if (lua_pcall(state, 3, 0, 0) != 0) code.error = lua_isstring(state, -1) != 0 ? lua_tostring(state, -1) : "?";
  std::ranges::sort(code.lines);
  code.lines.erase(std::unique(code.lines.begin(), code.lines.end()), code.lines.end());
  for (CodeLines::Function& function : code.functions) function.name = name_in(line_of_text(text, function.first));
  return code;
}

}  // namespace kadans
