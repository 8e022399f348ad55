#include "snapshot_tables.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "lua_core.h"
#include "sandbox.h"
#include "tick_code.h"

namespace kadans {
namespace {

// The field names, interned once.
// NOLINTBEGIN(readability-identifier-naming): they carry their units as the fields do
enum Key : int {
  position_rad = 1,
  velocity_rad_s,
  effort_Nm,
  roll_rad,
  pitch_rad,
  yaw_rad,
  tilt_rad,
  height_m,
  axis_x,
  axis_y,
  axis_z,
  contact,
  force_N,
  cop_x_m,
  cop_y_m,
  level,
  faults,
  first_fault,
  time_s,
  tick,
  key_count
};
// NOLINTEND(readability-identifier-naming)
constexpr const char* key_names[] = {"",
                                     "position_rad",
                                     "velocity_rad_s",
                                     "effort_Nm",
                                     "roll_rad",
                                     "pitch_rad",
                                     "yaw_rad",
                                     "tilt_rad",
                                     "height_m",
                                     "x",
                                     "y",
                                     "z",
                                     "contact",
                                     "force_N",
                                     "cop_x_m",
                                     "cop_y_m",
                                     "level",
                                     "faults",
                                     "first_fault",
                                     "time_s",
                                     "tick"};

// What `keys` holds at this number becomes a field of the table.
KADANS_TICK_CODE void put(lua_State* state, int table, int keys, Key key, double value) {
  lua_rawgeti(state, keys, key);
  lua_pushnumber(state, value);
  lua_rawset(state, table);
}

// first_read(content, key): a field that is not there, for nobody read this part yet, or at all. Upvalues: what
// messages call it, its content, the tables, the part's number.
int first_read(lua_State* state) {
  auto& tables = *static_cast<SnapshotTables*>(lua_touserdata(state, lua_upvalueindex(3)));
  tables.read_first(state, static_cast<std::size_t>(lua_tointeger(state, lua_upvalueindex(4))));
  if (lua_gettop(state) < 2) return 0;  // called to fill
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(2));
  if (!lua_isnil(state, -1)) return 1;
  return raise_unknown_field(state, lua_tostring(state, lua_upvalueindex(1)), lua_upvalueindex(2), 2);
}

}  // namespace

// [-0 +1] An empty table, content of a part.
void SnapshotTables::push_part(lua_State* state, Kind kind, std::size_t index) {
  core_of(state).heap.for_ticks(true);
  lua_createtable(state, 0, kind == Kind::joint ? 3 : 8);
  core_of(state).heap.for_ticks(false);
  lua_pushvalue(state, -1);
  parts_.push_back({kind, static_cast<std::uint32_t>(index), luaL_ref(state, LUA_REGISTRYINDEX)});
}

// The content of part `number`, at the top, becomes read-only; it is filled when something reads it.
void SnapshotTables::finish_part(lua_State* state, std::size_t number, const char* shown) {
  const int content = lua_gettop(state);
  lua_pushvalue(state, content);
  make_read_only(state, shown);
  if (on_demand_) {
    lua_getmetatable(state, content);
    lua_pushstring(state, shown);
    lua_pushvalue(state, content);
    lua_pushlightuserdata(state, this);
    lua_pushinteger(state, static_cast<lua_Integer>(number));
    lua_pushcclosure(state, first_read, 4);
    lua_pushvalue(state, -1);
    lua_setfield(state, -3, "__index");
    set_filler(state);
    lua_pop(state, 1);
  }
  lua_remove(state, content);
}

// [-0 +1]
void SnapshotTables::push_whole_part(lua_State* state, Kind kind, std::size_t index, const char* shown) {
  const LuaHeap& heap = core_of(state).heap;
  const std::byte* const first = heap.tick_end();
  push_part(state, kind, index);
  finish_part(state, parts_.size() - 1, shown);
  parts_.back().memory = {first, heap.tick_end()};
}

// [-0 +1]
void SnapshotTables::push_joints(lua_State* state, const RobotModel& model) {
  LuaHeap& heap = core_of(state).heap;
  const std::byte* const first = heap.tick_end();
  heap.for_ticks(true);
  lua_createtable(state, 0, static_cast<int>(model.joints.size()));
  heap.for_ticks(false);
  joints_ = {first, heap.tick_end()};
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    push_whole_part(state, Kind::joint, i, "a joint");
    lua_setfield(state, -2, model.joints[i].name.c_str());
  }
  make_read_only(state, "s.joints");
}

int SnapshotTables::open(lua_State* state, const RobotModel& model, const std::vector<std::string>& feet,
                         bool on_demand) {
  on_demand_ = on_demand;
  push_names(state);
  push_part(state, Kind::root, 0);
  push_joints(state, model);
  lua_setfield(state, -2, "joints");
  push_part(state, Kind::base, 0);
  const std::size_t base = parts_.size() - 1;
  push_whole_part(state, Kind::rate, 0, "s.base.angular_velocity_rad_s");
  lua_setfield(state, -2, "angular_velocity_rad_s");
  finish_part(state, base, "s.base");
  lua_setfield(state, -2, "base");
  lua_newtable(state);
  for (std::size_t i = 0; i < std::min(feet.size(), max_feet); ++i) {
    push_whole_part(state, Kind::foot, i, "a foot");
    lua_setfield(state, -2, feet[i].c_str());
  }
  make_read_only(state, "s.feet");
  lua_setfield(state, -2, "feet");
  push_whole_part(state, Kind::support, 0, "s.support");
  lua_setfield(state, -2, "support");
  push_whole_part(state, Kind::safety, 0, "s.safety");
  lua_setfield(state, -2, "safety");
  finish_part(state, 0, "s");
  read_.reserve(parts_.size());
  for (std::size_t i = 0; !on_demand && i < parts_.size(); ++i) read_first(state, i);
  return luaL_ref(state, LUA_REGISTRYINDEX);
}

void SnapshotTables::push_names(lua_State* state) {
  lua_createtable(state, key_count, 0);
  for (int key = 1; key < key_count; ++key) {
    lua_pushstring(state, key_names[key]);
    lua_rawseti(state, -2, key);
  }
  keys_ = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_createtable(state, 8, 0);
  for (int i = 0; i <= static_cast<int>(SafetyLevel::off); ++i) {
    lua_pushstring(state, name(static_cast<SafetyLevel>(i)));
    lua_rawseti(state, -2, i + 1);
  }
  levels_ = luaL_ref(state, LUA_REGISTRYINDEX);
}

KADANS_TICK_CODE void SnapshotTables::refill(lua_State* state, const Snapshot& snapshot, std::int64_t now_ns) {
  snapshot_ = &snapshot;
  now_ns_ = now_ns;
  if (read_.empty()) return;
  luaL_checkstack(state, 8, "snapshot");
  lua_rawgeti(state, LUA_REGISTRYINDEX, keys_);
  for (const std::uint16_t number : read_) fill(state, parts_[number]);
  lua_pop(state, 1);
}

KADANS_TICK_CODE void SnapshotTables::warm_up() const noexcept {
  if (!read_.empty()) WarmUp::read(joints_);
  for (const std::uint16_t number : read_) WarmUp::read(parts_[number].memory);
}

void SnapshotTables::read_first(lua_State* state, std::size_t number) {
  Part& part = parts_[number];
  if (part.read) return;
  luaL_checkstack(state, 8, "snapshot");
  lua_rawgeti(state, LUA_REGISTRYINDEX, keys_);
  fill(state, part);
  lua_pop(state, 1);
  part.read = true;
  read_.push_back(static_cast<std::uint16_t>(number));
}

// The names are at the top.
KADANS_TICK_CODE void SnapshotTables::fill(lua_State* state, const Part& part) const {
  const int keys = lua_gettop(state), table = keys + 1;
  lua_rawgeti(state, LUA_REGISTRYINDEX, part.content);
  const auto set = [=](std::initializer_list<std::pair<Key, double>> fields) {
    for (const auto& [key, value] : fields) put(state, table, keys, key, value);
  };
  const RobotStatus& status = snapshot_->status;
  const BaseStatus& base = status.base;
  const auto& rate = base.angular_velocity_rad_s;
  const JointState& joint = snapshot_->joints.joints[part.kind == Kind::joint ? part.index : 0];
  switch (part.kind) {
    case Kind::joint:
      set({{position_rad, joint.position_rad}, {velocity_rad_s, joint.velocity_rad_s}, {effort_Nm, joint.effort_Nm}});
      break;
    case Kind::base:
      set({{roll_rad, base.roll_rad}, {pitch_rad, base.pitch_rad}, {yaw_rad, base.yaw_rad}});
      set({{tilt_rad, base.tilt_rad}, {height_m, base.height_m}});
      break;
    case Kind::rate:
      set({{axis_x, rate[0]}, {axis_y, rate[1]}, {axis_z, rate[2]}});
      break;
    case Kind::foot:
      fill_foot(state, keys, status.feet[part.index]);
      break;
    case Kind::support:
      set({{force_N, status.support.force_N}, {cop_x_m, status.support.cop_x_m}, {cop_y_m, status.support.cop_y_m}});
      break;
    case Kind::safety:
      fill_safety(state, keys, status.safety);
      break;
    case Kind::root:
      set({{time_s, static_cast<double>(now_ns_) / 1e9}, {tick, static_cast<double>(snapshot_->tick)}});
      break;
  }
  lua_settop(state, keys);
}

// The content is at the top.
void SnapshotTables::fill_foot(lua_State* state, int keys, const FootStatus& foot) const {
  const int table = lua_gettop(state);
  lua_rawgeti(state, keys, contact);
  lua_pushboolean(state, foot.contact ? 1 : 0);
  lua_rawset(state, table);
  put(state, table, keys, force_N, foot.force_N);
  put(state, table, keys, cop_x_m, foot.cop_x_m);
  put(state, table, keys, cop_y_m, foot.cop_y_m);
}

void SnapshotTables::fill_safety(lua_State* state, int keys, const SafetyStatus& status) const {
  const int table = lua_gettop(state);
  lua_rawgeti(state, keys, level);
  lua_rawgeti(state, LUA_REGISTRYINDEX, levels_);
  lua_rawgeti(state, -1, static_cast<int>(status.level) + 1);
  lua_remove(state, -2);
  lua_rawset(state, table);
  put(state, table, keys, faults, status.fault_count);
  put(state, table, keys, first_fault, static_cast<double>(status.first_fault.code));
}

}  // namespace kadans
