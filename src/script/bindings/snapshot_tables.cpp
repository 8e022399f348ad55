#include "snapshot_tables.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "script/bindings/bindings.h"
#include "script/lua/lua_core.h"
#include "script/lua/lua_state.h"
#include "script/sandbox/sandbox.h"

namespace kadans {
namespace {

// first_read(content, key): a field that is not there, for nobody read it yet, or at all. Upvalues: what
// messages call it, its content, the tables, the part's number.
int first_read(lua_State* state) {
  auto& tables = *static_cast<SnapshotTables*>(lua_touserdata(state, lua_upvalueindex(3)));
  const auto part = static_cast<std::size_t>(lua_tointeger(state, lua_upvalueindex(4)));
  const bool whole = lua_gettop(state) < 2;  // called to fill
  if (whole || !tables.read_first(state, part, 2)) tables.read_whole(state, part);
  if (whole) return 0;
  lua_pushvalue(state, 2);
  lua_rawget(state, lua_upvalueindex(2));
  if (!lua_isnil(state, -1)) return 1;
  return raise_unknown_field(state, lua_tostring(state, lua_upvalueindex(1)), lua_upvalueindex(2), 2);
}

// The same of s.event (content, key): only its data is made when it is read. Upvalue: the content.
int first_read_of_event(lua_State* state) {
  const bool whole = lua_gettop(state) < 2;
  const bool data = whole || (lua_type(state, 2) == LUA_TSTRING && std::strcmp(lua_tostring(state, 2), "data") == 0);
  const auto* bindings = static_cast<const Bindings*>(core_of(state).bindings);
  if (!data || bindings == nullptr || bindings->runner == nullptr) return 0;
  lua_settop(state, 0);
  lua_pushliteral(state, "data");
  bindings->runner->push_shown_data(state);
  lua_pushvalue(state, 2);
  lua_insert(state, 1);
  lua_rawset(state, lua_upvalueindex(1));
  return whole ? 0 : 1;
}

// In this order one behind the other.
struct Sizes {
  std::uint32_t array = 0;
  std::uint32_t hash_mask = 0;  // slots in the hash - 1
  bool operator==(const Sizes&) const = default;
};

struct Sample {
  int array, hash;  // asked for
  Sizes kept;
};
constexpr std::array<Sample, 4> samples{
    {{0, 0, {0, 0}}, {100, 0, {101, 0}}, {0, 50, {0, 63}}, {200, 1000, {201, 1023}}}};
constexpr std::ptrdiff_t table_bytes = 8 * sizeof(void*);  // at least

Sizes sizes_at(const void* table, std::ptrdiff_t place) noexcept {
  Sizes sizes;
  std::memcpy(&sizes, static_cast<const std::byte*>(table) + place, sizeof sizes);
  return sizes;
}

}  // namespace

void SnapshotTables::open_shelf(lua_State* state) {
  shelf_ = lua_newthread(state);
  luaL_ref(state, LUA_REGISTRYINDEX);
}

// [-1 +0]
void SnapshotTables::put_on_shelf(lua_State* state) {
  if (lua_checkstack(shelf_, 8) == 0) luaL_error(state, "not enough memory for the snapshot");
  lua_xmove(state, shelf_, 1);
}

// [-0 +1] An empty table, content of a part.
void SnapshotTables::push_part(lua_State* state, Kind kind, std::size_t index) {
  core_of(state).heap.for_ticks(true);
  lua_createtable(state, 0, kind == Kind::joint ? 3 : 8);
  core_of(state).heap.for_ticks(false);
  lua_pushvalue(state, -1);
  put_on_shelf(state);
  parts_.push_back({kind, static_cast<std::uint32_t>(index)});
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
  push_part(state, kind, index);
  finish_part(state, parts_.size() - 1, shown);
}

// [-0 +1]
void SnapshotTables::push_joints(lua_State* state, const RobotModel& model) {
  LuaHeap& heap = core_of(state).heap;
  heap.for_ticks(true);
  lua_createtable(state, 0, static_cast<int>(model.joints.size()));
  heap.for_ticks(false);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    push_whole_part(state, Kind::joint, i, "a joint");
    lua_setfield(state, -2, model.joints[i].name.c_str());
  }
  make_read_only(state, "s.joints");
}

// [-0 +1] The entries of the world model; without one of that name, the ball that a scenario's `sight` shows.
void SnapshotTables::push_seen(lua_State* state, const std::vector<SeenInfo>& entries) {
  lua_createtable(state, 0, static_cast<int>(entries.size()) + 1);
  push_whole_part(state, Kind::ball, 0, "s.seen.ball");
  lua_setfield(state, -2, "ball");
  for (std::size_t i = 0; i < std::min(entries.size(), max_seen); ++i) {
    lua_pushfstring(state, "s.seen.%s", entries[i].name.c_str());
    push_whole_part(state, Kind::seen, i, lua_tostring(state, -1));
    lua_setfield(state, -3, entries[i].name.c_str());
    lua_pop(state, 1);
  }
  make_read_only(state, "s.seen");
}

int SnapshotTables::open(lua_State* state, const Catalog& catalog, bool on_demand) {
  on_demand_ = on_demand;
  fields_ = status_fields(catalog.sensors, catalog.seen);
  open_shelf(state);
  push_names(state);
  push_part(state, Kind::root, 0);
  push_joints(state, *catalog.model);
  lua_setfield(state, -2, "joints");
  push_part(state, Kind::base, 0);
  const std::size_t base = parts_.size() - 1;
  push_whole_part(state, Kind::rate, 0, "s.base.angular_velocity_rad_s");
  lua_setfield(state, -2, "angular_velocity_rad_s");
  finish_part(state, base, "s.base");
  lua_setfield(state, -2, "base");
  lua_newtable(state);
  for (std::size_t i = 0; i < std::min(catalog.feet.size(), max_feet); ++i) {
    push_whole_part(state, Kind::foot, i, "a foot");
    lua_setfield(state, -2, catalog.feet[i].name.c_str());
  }
  make_read_only(state, "s.feet");
  lua_setfield(state, -2, "feet");
  push_whole_part(state, Kind::support, 0, "s.support");
  lua_setfield(state, -2, "support");
  push_whole_part(state, Kind::odometry, 0, "s.odometry");
  lua_setfield(state, -2, "odometry");
  push_whole_part(state, Kind::safety, 0, "s.safety");
  lua_setfield(state, -2, "safety");
  push_whole_part(state, Kind::joystick, 0, "s.joystick");
  lua_setfield(state, -2, "joystick");
  push_seen(state, catalog.seen);
  lua_setfield(state, -2, "seen");
  push_whole_part(state, Kind::sensors, 0, "s.sensors");
  lua_setfield(state, -2, "sensors");
  lua_createtable(state, 0, 2);
  lua_pushvalue(state, -1);
  event_ = luaL_ref(state, LUA_REGISTRYINDEX);
  lua_createtable(state, 0, 2);
  lua_pushvalue(state, -2);
  lua_pushcclosure(state, first_read_of_event, 1);
  lua_pushvalue(state, -1);
  lua_setfield(state, -3, "__index");
  set_filler(state);
  lua_setmetatable(state, -2);
  make_read_only(state, "s.event", false);
  lua_setfield(state, -2, "event");
  finish_part(state, 0, "s");
  std::size_t all = 0;
  for (const Part& part : parts_)
    all += static_cast<std::size_t>(
        std::ranges::count_if(fields_, [&](const StatusField& field) { return field.is_of(part.kind, part.index); }));
  read_.reserve(all);
  for (std::size_t i = 0; !on_demand && i < parts_.size(); ++i) read_whole(state, i);
  return luaL_ref(state, LUA_REGISTRYINDEX);
}

// [-0 +0] The names of a choice's values, as a registry reference.
int SnapshotTables::push_choices(lua_State* state, const StatusField& field) {
  lua_createtable(state, static_cast<int>(field.choices), 0);
  for (std::size_t value = 0; value < field.choices; ++value) {
    lua_pushstring(state, field.choice(value));
    lua_rawseti(state, -2, static_cast<int>(value) + 1);
  }
  return luaL_ref(state, LUA_REGISTRYINDEX);
}

void SnapshotTables::push_names(lua_State* state) {
  for (const StatusField& field : fields_) {
    lua_pushstring(state, field.name);
    put_on_shelf(state);
    choices_.push_back(field.type == Type::choice ? push_choices(state, field) : LUA_NOREF);
  }
}

void SnapshotTables::refill(const Snapshot& snapshot, std::int64_t now_ns) {
  snapshot_ = &snapshot;
  now_ns_ = now_ns;
  for (const Read read : read_) {  // fields that are there: no memory is asked for
    lua_pushvalue(shelf_, read.field + 1);
    push_value(shelf_, read.field, parts_[read.part].index);
    lua_rawset(shelf_, content(read.part));
  }
}

// [-0 +1]
void SnapshotTables::push_value(lua_State* state, std::size_t at, std::size_t index) const {
  const StatusField& field = fields_[at];
  const double value = field.at == nullptr ? static_cast<double>(now_ns_) / 1e9 : field.value(*snapshot_, index);
  if (field.type == Type::number) return lua_pushnumber(state, value);
  if (field.type == Type::flag) return lua_pushboolean(state, value != 0 ? 1 : 0);
  push_entry(state, choices_[at], static_cast<int>(value) + 1);
}

bool SnapshotTables::read_first(lua_State* state, std::size_t part, int key) {
  if (lua_type(state, key) != LUA_TSTRING) return false;
  const std::string_view name = lua_tostring(state, key);
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (fields_[i].is_of(parts_[part].kind, parts_[part].index) && fields_[i].name == name)
      return read_field(state, part, i), true;
  }
  return false;
}

void SnapshotTables::read_whole(lua_State* state, std::size_t part) {
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    if (fields_[i].is_of(parts_[part].kind, parts_[part].index)) read_field(state, part, i);
  }
}

void SnapshotTables::read_field(lua_State* state, std::size_t part, std::size_t field) {
  if (parts_[part].read[field]) return;
  luaL_checkstack(state, 8, "snapshot");
  lua_pushvalue(shelf_, content(part));
  lua_pushvalue(shelf_, static_cast<int>(field) + 1);
  lua_xmove(shelf_, state, 2);
  push_value(state, field, parts_[part].index);
  lua_rawset(state, -3);
  lua_pop(state, 1);
  parts_[part].read[field] = true;
  const Read read{static_cast<std::uint16_t>(part), static_cast<std::uint16_t>(field)};
  read_.insert(std::ranges::upper_bound(read_, read.part, {}, &Read::part), read);
}

void TableSlots::find_place(lua_State* state) {
  std::array<const void*, samples.size()> tables{};
  luaL_checkstack(state, static_cast<int>(samples.size()), "tables");
  const int top = lua_gettop(state);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    lua_createtable(state, samples[i].array, samples[i].hash);
    tables[i] = lua_topointer(state, -1);
  }
  for (std::ptrdiff_t place = 0; place + std::ptrdiff_t{sizeof(Sizes)} <= table_bytes; place += sizeof(std::uint32_t)) {
    bool fits = true;
    for (std::size_t i = 0; i < samples.size(); ++i) fits = fits && sizes_at(tables[i], place) == samples[i].kept;
    if (fits) place_ = place;
  }
  lua_settop(state, top);
}

std::size_t TableSlots::steps(lua_State* state, int index) const noexcept {
  constexpr std::size_t steps_per_hash_slot = 2;
  if (!known()) return core_of(state).limits.block_bytes / sizeof(lua_Number);
  const Sizes sizes = sizes_at(lua_topointer(state, index), place_);
  return std::size_t{sizes.array} + steps_per_hash_slot * (std::size_t{sizes.hash_mask} + 1);
}

void charge_table(lua_State* state, int index) {
  StepMeter meter(state);
  meter.spend(core_of(state).slots.steps(state, index));
  meter.settle();
}

}  // namespace kadans
