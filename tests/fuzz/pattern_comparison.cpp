#include "pattern_comparison.h"

#include <algorithm>
#include <cstdlib>
#include <new>

#include <lua.hpp>

#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"

namespace kadans::fuzz {
namespace {

constexpr std::uint64_t instructions_max = 40'000;

constexpr const char* driver = R"(
local which, number, pattern, replacement, subject = ...
local told = {}
local function tell(...)
  for i = 1, select('#', ...) do
    local value = select(i, ...)
    told[#told + 1] = type(value) .. ' ' .. tostring(value) .. '\n'
  end
  return ...
end
local replacements = setmetatable({}, { __index = function(_, key)
  if key == 'n' then return nil elseif key == 'f' then return false elseif key == 't' then return told end
  return key == 'd' and 12.5 or '<' .. tostring(key) .. '>'
end })
local function replace(first, ...)
  tell(first, ...)
  return replacements[first]
end
tell(pcall(function()
  if which == 'f' then tell(string.find(subject, pattern, number))
  elseif which == 'p' then tell(string.find(subject, pattern, number, true))
  elseif which == 'm' then tell(string.match(subject, pattern, number))
  elseif which == 's' then tell(string.gsub(subject, pattern, replacement, number))
  elseif which == 't' then tell(string.gsub(subject, pattern, replacements, number))
  elseif which == 'c' then tell(string.gsub(subject, pattern, replace, number))
  else
    local count = 0
    for a, b, c in string.gmatch(subject, pattern) do
      tell(a, b, c)
      count = count + 1
      if count > 200 then break end
    end
  end
end))
return table.concat(told)
)";

struct Case {
  std::string which;
  bool numbered = false;
  double number = 0;
  std::string_view pattern, replacement, subject;
};

std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

Case read_case(std::string_view text) {
  Case read;
  const std::string_view head = take_line(text);
  const std::size_t which = functions.find(head.empty() ? 'f' : head[0]);
  read.which = functions[which == std::string_view::npos ? 0 : which];
  const std::string number(head.substr(std::min<std::size_t>(head.size(), 1)));
  char* end = nullptr;
  read.number = std::strtod(number.c_str(), &end);
  read.numbered = end != number.c_str();
  read.pattern = take_line(text);
  read.replacement = take_line(text);
  read.subject = text;
  return read;
}

struct Call {
  const Case& given;
  int driver = LUA_NOREF;  // registry
  std::string result{};
};

int call_driver(lua_State* state) {
  Call& call = *static_cast<Call*>(lua_touserdata(state, 1));
  const auto push = [state](std::string_view text) { lua_pushlstring(state, text.data(), text.size()); };
  lua_rawgeti(state, LUA_REGISTRYINDEX, call.driver);
  push(call.given.which);
  if (call.given.numbered) {
    lua_pushnumber(state, call.given.number);
  } else {
    lua_pushnil(state);
  }
  push(call.given.pattern);
  push(call.given.replacement);
  push(call.given.subject);
  lua_call(state, 5, 1);
  std::size_t length = 0;
  const char* text = lua_tolstring(state, -1, &length);
  call.result.assign(text, length);
  return 0;
}

int make_driver(lua_State* state) {
  int& made = *static_cast<int*>(lua_touserdata(state, 1));
  if (luaL_loadbuffer(state, driver, std::char_traits<char>::length(driver), "=driver") != 0) return lua_error(state);
  push_environment(state);
  lua_setfenv(state, -2);
  made = luaL_ref(state, LUA_REGISTRYINDEX);
  return 0;
}

}  // namespace

struct PatternComparison::Parts {
  LuaState sandbox{{.root = {}, .folder = {}, .name = "patterns", .seed = 1, .limits = {}, .voice = nullptr}};
  lua_State* lua = luaL_newstate();
  int sandbox_driver = LUA_NOREF, lua_driver = LUA_NOREF;
  std::string sandbox_result{}, lua_result{};

  Parts() {
    if (lua == nullptr || !sandbox.call(make_driver, &sandbox_driver, instructions_max, 0)) throw std::bad_alloc();
    luaL_openlibs(lua);
    luaJIT_setmode(lua, 0, LUAJIT_MODE_ENGINE | LUAJIT_MODE_OFF);
    if (luaL_loadbuffer(lua, driver, std::char_traits<char>::length(driver), "=driver") != 0) throw std::bad_alloc();
    lua_driver = luaL_ref(lua, LUA_REGISTRYINDEX);
  }
  ~Parts() { lua_close(lua); }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;
};

PatternComparison::PatternComparison() : parts_(std::make_unique<Parts>()) {}
PatternComparison::~PatternComparison() = default;

bool PatternComparison::run(std::string_view text) {
  Parts& parts = *parts_;
  const Case given = read_case(text);
  Call sandboxed{given, parts.sandbox_driver}, plain{given, parts.lua_driver};
  const bool ended = parts.sandbox.call(call_driver, &sandboxed, instructions_max, 0);
  parts.sandbox.collect();
  parts.sandbox_result = ended ? sandboxed.result : parts.sandbox.error().text();
  if (!ended && parts.sandbox.error().breach != ScriptBreach::none) return false;
  lua_settop(parts.lua, 0);
  const bool raised = lua_cpcall(parts.lua, call_driver, &plain) != 0;
  parts.lua_result = raised ? lua_tostring(parts.lua, -1) : plain.result;
  return true;
}

const std::string& PatternComparison::sandbox() const noexcept { return parts_->sandbox_result; }
const std::string& PatternComparison::lua() const noexcept { return parts_->lua_result; }

}  // namespace kadans::fuzz
