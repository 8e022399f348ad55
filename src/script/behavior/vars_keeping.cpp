#include "vars_keeping.h"

#include <cstring>

#include "script/motion/motion.h"
#include "vars_transfer.h"

namespace kadans {
namespace {

constexpr std::size_t kept_bytes_max = std::size_t{256} << 10U;
enum Tag : std::uint8_t { tag_nil, tag_false, tag_true, tag_number, tag_string, tag_table, tag_end, tag_motion };

bool put_table(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth) {
  if (depth > vars_depth_max || lua_checkstack(state, 8) == 0) return why = "vars are nested too deeply", false;
  bytes.put<std::uint8_t>(tag_table);
  for (lua_pushnil(state); lua_next(state, index) != 0; lua_pop(state, 1)) {
    if (bytes.size() > kept_bytes_max) return why = "vars hold too much", false;  // the same table twice counts twice
    const int value = lua_gettop(state);
    if (!put_value(state, value - 1, bytes, why, depth + 1) || !put_value(state, value, bytes, why, depth + 1))
      return false;
  }
  bytes.put<std::uint8_t>(tag_end);
  return true;
}

bool put_motion(lua_State* state, int index, ByteWriter& bytes, std::string& why) {
  Motion* motion = to_motion(state, index);
  if (motion == nullptr) return why = "vars hold a userdata", false;
  bytes.put<std::uint8_t>(tag_motion);
  bytes.put(std::as_bytes(std::span(motion, 1)));
  bytes.put(std::as_bytes(std::span(motion->setpoints(), motion->count)));
  return true;
}

void push_motion_of(lua_State* state, ByteReader& bytes, const Catalog& catalog) {
  Motion kept;
  const auto fixed = bytes.take_bytes(sizeof kept);
  if (!fixed.empty()) std::memcpy(static_cast<void*>(&kept), fixed.data(), sizeof kept);
  const auto setpoints = bytes.take_bytes(std::uint64_t{kept.count} * sizeof(SetpointId));
  if (!bytes.ok() || kept.state > MotionState::expired) luaL_error(state, "no motion was kept here");
  Motion* motion = push_motion(state, kept.count);
  std::memcpy(static_cast<void*>(motion), &kept, sizeof kept);
  std::memcpy(motion->setpoints(), setpoints.data(), setpoints.size());
  for (std::uint32_t i = 0; i < kept.count; ++i) {
    if (motion->setpoints()[i] >= catalog.setpoints.size()) luaL_error(state, "a motion of no set-point was kept");
  }
}

// Until the end of the table; a key that is no key raises.
void push_table(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth) {
  if (depth > vars_depth_max) luaL_error(state, "what was kept is nested too deeply");
  luaL_checkstack(state, 8, "what was kept is nested too deeply");
  lua_newtable(state);
  for (;;) {
    ByteReader ahead = bytes;
    if (ahead.take<std::uint8_t>() == tag_end && ahead.ok()) return static_cast<void>(bytes = ahead);
    push_value(state, bytes, catalog, depth + 1);
    push_value(state, bytes, catalog, depth + 1);
    const bool key = lua_type(state, -2) != LUA_TNIL &&
                     (lua_type(state, -2) != LUA_TNUMBER || lua_tonumber(state, -2) == lua_tonumber(state, -2));
    if (!key) luaL_error(state, "a table without a key was kept");
    lua_rawset(state, -3);
  }
}

}  // namespace

bool put_value(lua_State* state, int index, ByteWriter& bytes, std::string& why, int depth) {
  switch (lua_type(state, index)) {
    case LUA_TNIL:
      return bytes.put<std::uint8_t>(tag_nil), true;
    case LUA_TBOOLEAN:
      return bytes.put<std::uint8_t>(lua_toboolean(state, index) != 0 ? tag_true : tag_false), true;
    case LUA_TNUMBER:
      bytes.put<std::uint8_t>(tag_number);
      return bytes.put(lua_tonumber(state, index)), true;
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(state, index, &length);
      bytes.put<std::uint8_t>(tag_string);
      return bytes.put_string({text, length}), true;
    }
    case LUA_TTABLE:
      return put_table(state, index, bytes, why, depth);
    case LUA_TUSERDATA:
      return put_motion(state, index, bytes, why);
    default:
      return why = std::string("vars hold a ") + lua_typename(state, lua_type(state, index)), false;
  }
}

void push_value(lua_State* state, ByteReader& bytes, const Catalog& catalog, int depth) {
  const auto tag = bytes.take<std::uint8_t>();
  if (!bytes.ok()) luaL_error(state, "what was kept ends too early");
  switch (tag) {
    case tag_nil:
      return lua_pushnil(state);
    case tag_false:
    case tag_true:
      return lua_pushboolean(state, tag == tag_true ? 1 : 0);
    case tag_number:
      return lua_pushnumber(state, bytes.take<double>());
    case tag_string: {
      const auto text = bytes.take_bytes(bytes.take<std::uint32_t>());
      return lua_pushlstring(state, reinterpret_cast<const char*>(text.data()), text.size());
    }
    case tag_table:
      return push_table(state, bytes, catalog, depth);
    case tag_motion:
      return push_motion_of(state, bytes, catalog);
    default:
      luaL_error(state, "what was kept is no value");
  }
}

}  // namespace kadans
