#include "snapshot_tables.h"

#include <algorithm>

#include "sandbox.h"

namespace kadans {
namespace {

// The field names, interned once: their strings sit on the stack while the tables are refilled.
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

void put(lua_State* state, int table, int key, double value) {
  lua_pushvalue(state, key);
  lua_pushnumber(state, value);
  lua_rawset(state, table);
}

// [-0 +1] A table with these fields, numbers all.
void push_fields(lua_State* state, std::initializer_list<Key> fields) {
  lua_newtable(state);
  for (const Key key : fields) {
    lua_pushnumber(state, 0);
    lua_setfield(state, -2, key_names[key]);
  }
}

// The table at the top becomes field `name` of the table below it, read-only. Returns a reference to its content.
int attach(lua_State* state, const char* name, const char* shown) {
  lua_pushvalue(state, -1);
  const int content = luaL_ref(state, LUA_REGISTRYINDEX);
  make_read_only(state, shown);
  lua_setfield(state, -2, name);
  return content;
}

}  // namespace

int SnapshotTables::open(lua_State* state, const RobotModel& model, const std::vector<std::string>& feet) {
  joints_ = model.joints.size();
  feet_ = std::min(feet.size(), max_feet);
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

  push_fields(state, {time_s, tick});
  const int root = lua_gettop(state);
  lua_newtable(state);  // joints
  lua_newtable(state);
  for (std::size_t i = 0; i < joints_; ++i) {
    push_fields(state, {position_rad, velocity_rad_s, effort_Nm});
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, static_cast<int>(i + 1));
    make_read_only(state, "a joint");
    lua_setfield(state, -3, model.joints[i].name.c_str());
  }
  joint_tables_ = luaL_ref(state, LUA_REGISTRYINDEX);
  luaL_unref(state, LUA_REGISTRYINDEX, attach(state, "joints", "s.joints"));
  push_fields(state, {roll_rad, pitch_rad, yaw_rad, tilt_rad, height_m});
  push_fields(state, {axis_x, axis_y, axis_z});
  rate_ = attach(state, "angular_velocity_rad_s", "s.base.angular_velocity_rad_s");
  base_ = attach(state, "base", "s.base");
  lua_newtable(state);  // feet
  lua_newtable(state);
  for (std::size_t i = 0; i < feet_; ++i) {
    push_fields(state, {contact, force_N, cop_x_m, cop_y_m});
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, static_cast<int>(i + 1));
    make_read_only(state, "a foot");
    lua_setfield(state, -3, feet[i].c_str());
  }
  foot_tables_ = luaL_ref(state, LUA_REGISTRYINDEX);
  luaL_unref(state, LUA_REGISTRYINDEX, attach(state, "feet", "s.feet"));
  push_fields(state, {force_N, cop_x_m, cop_y_m});
  support_ = attach(state, "support", "s.support");
  push_fields(state, {level, faults, first_fault});
  safety_ = attach(state, "safety", "s.safety");
  lua_pushvalue(state, root);
  root_ = luaL_ref(state, LUA_REGISTRYINDEX);
  make_read_only(state, "s");
  return luaL_ref(state, LUA_REGISTRYINDEX);
}

void SnapshotTables::refill(lua_State* state, const Snapshot& snapshot, std::int64_t now_ns) const {
  const int bottom = lua_gettop(state);
  luaL_checkstack(state, key_count + 8, "snapshot");
  lua_rawgeti(state, LUA_REGISTRYINDEX, keys_);
  const auto key = [bottom](Key which) { return bottom + 1 + which; };
  for (int i = 1; i < key_count; ++i) lua_rawgeti(state, bottom + 1, i);
  const auto into = [state](int reference) {
    lua_rawgeti(state, LUA_REGISTRYINDEX, reference);
    return lua_gettop(state);
  };

  const int lists = into(joint_tables_);
  for (std::size_t i = 0; i < joints_; ++i) {
    lua_rawgeti(state, lists, static_cast<int>(i + 1));
    put(state, lists + 1, key(position_rad), snapshot.joints.joints[i].position_rad);
    put(state, lists + 1, key(velocity_rad_s), snapshot.joints.joints[i].velocity_rad_s);
    put(state, lists + 1, key(effort_Nm), snapshot.joints.joints[i].effort_Nm);
    lua_settop(state, lists);
  }
  const BaseStatus& base = snapshot.status.base;
  const int body = into(base_);
  put(state, body, key(roll_rad), base.roll_rad);
  put(state, body, key(pitch_rad), base.pitch_rad);
  put(state, body, key(yaw_rad), base.yaw_rad);
  put(state, body, key(tilt_rad), base.tilt_rad);
  put(state, body, key(height_m), base.height_m);
  const int rate = into(rate_);
  put(state, rate, key(axis_x), base.angular_velocity_rad_s[0]);
  put(state, rate, key(axis_y), base.angular_velocity_rad_s[1]);
  put(state, rate, key(axis_z), base.angular_velocity_rad_s[2]);
  lua_settop(state, lists - 1);

  const int soles = into(foot_tables_);
  for (std::size_t i = 0; i < feet_; ++i) {
    const FootStatus& foot = snapshot.status.feet[i];
    lua_rawgeti(state, soles, static_cast<int>(i + 1));
    lua_pushvalue(state, key(contact));
    lua_pushboolean(state, foot.contact ? 1 : 0);
    lua_rawset(state, soles + 1);
    put(state, soles + 1, key(force_N), foot.force_N);
    put(state, soles + 1, key(cop_x_m), foot.cop_x_m);
    put(state, soles + 1, key(cop_y_m), foot.cop_y_m);
    lua_settop(state, soles);
  }
  const SupportStatus& ground = snapshot.status.support;
  const int support = into(support_);
  put(state, support, key(force_N), ground.force_N);
  put(state, support, key(cop_x_m), ground.cop_x_m);
  put(state, support, key(cop_y_m), ground.cop_y_m);
  const SafetyStatus& status = snapshot.status.safety;
  const int safety = into(safety_);
  const int levels = into(levels_);
  lua_pushvalue(state, key(level));
  lua_rawgeti(state, levels, static_cast<int>(status.level) + 1);
  lua_rawset(state, safety);
  put(state, safety, key(faults), status.fault_count);
  put(state, safety, key(first_fault), static_cast<double>(status.first_fault.code));
  const int root = into(root_);
  put(state, root, key(time_s), static_cast<double>(now_ns) / 1e9);
  put(state, root, key(tick), static_cast<double>(snapshot.tick));
  lua_settop(state, bottom);
}

}  // namespace kadans
