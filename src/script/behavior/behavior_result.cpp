// The result of a behavior as text that Lua can read: { place = "left", steps = 3 }.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "behavior_parts.h"
#include "kadans/signal/nearest_name.h"
#include "script/check/source_lexer.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

constexpr int result_depth_max = 8;

std::string literal(lua_State* state, int index, int depth);

std::string number_literal(double number) {
  if (std::isnan(number)) return "0/0";
  if (std::isinf(number)) return number > 0 ? "1/0" : "-1/0";
  return number_text(number);
}

std::string text_literal(lua_State* state, int index) {
  std::size_t length = 0;
  const char* text = lua_tolstring(state, index, &length);
  std::string quoted = "\"";
  for (std::size_t i = 0; i < length; ++i) {
    const auto letter = static_cast<unsigned char>(text[i]);
    if (letter == '"' || letter == '\\') quoted += '\\';
    quoted += letter < ' ' || letter == 0x7f ? printed("\\%03u", unsigned{letter}) : std::string(1, text[i]);
  }
  return quoted + "\"";
}

bool is_name(const std::string& text) {
  return is_word(text) && starts_name(text[0]) && (!is_keyword(text) || text == "goto");  // which LuaJIT takes for one
}

struct ResultField {
  bool named = false;
  double number = 0;
  std::string key, value;
};

std::string table_literal(lua_State* state, int table, int depth) {
  if (depth > result_depth_max || lua_checkstack(state, 6) == 0) return "{}";
  std::vector<ResultField> fields;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) {
    const int key = lua_gettop(state) - 1;
    ResultField& field = fields.emplace_back();
    field.named = lua_type(state, key) == LUA_TSTRING;
    field.number = field.named ? 0 : lua_tonumber(state, key);
    if (field.named) field.key = lua_tostring(state, key);
    if (field.named && !is_name(field.key)) field.key = "[" + text_literal(state, key) + "]";
    field.value = literal(state, key + 1, depth + 1);
  }
  const auto order = [](const ResultField& field) { return std::tie(field.named, field.number, field.key); };
  std::ranges::sort(fields, {}, order);
  std::string text;
  double next = 1;
  for (const ResultField& field : fields) {
    text += text.empty() ? " " : ", ";
    if (field.named) text += field.key + " = ";
    if (!field.named && field.number != next) text += "[" + number_literal(field.number) + "] = ";
    if (!field.named && field.number == next) ++next;
    text += field.value;
  }
  return "{" + text + (text.empty() ? "}" : " }");
}

std::string literal(lua_State* state, int index, int depth) {
  switch (lua_type(state, index)) {
    case LUA_TBOOLEAN:
      return lua_toboolean(state, index) != 0 ? "true" : "false";
    case LUA_TNUMBER:
      return number_literal(lua_tonumber(state, index));
    case LUA_TSTRING:
      return text_literal(state, index);
    case LUA_TTABLE:
      return table_literal(state, index, depth);
    default:
      return "nil";
  }
}

}  // namespace

std::string result_text(const Behavior::Parts& parts) {
  lua_State* state = parts.lua->get();
  if (lua_checkstack(state, 8) == 0 || !parts.runner->push_result(state)) return "";
  std::string text = literal(state, lua_gettop(state), 0);
  lua_pop(state, 1);
  return text;
}

}  // namespace kadans
