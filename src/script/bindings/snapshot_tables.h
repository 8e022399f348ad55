// `s`: the snapshot as scripts see it. The tables are made once. Each tick replaces only their fields, and only those
// that this script has read before: the first read of a field fills it, and from then on each tick refills it.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <lua.hpp>

#include "kadans/control/catalog.h"
#include "signal/status_fields.h"

namespace kadans {

class SnapshotTables {
 public:
  // Makes the tables and returns the registry reference of `s`. With `on_demand` this object must outlive the state and
  // must not move; without it every field is refilled each time. Raises.
  int open(lua_State* state, const Catalog& catalog, bool on_demand = false);
  // After open(): registry reference of the content of s.event, which the chart's runner fills.
  int event() const noexcept { return event_; }
  // The snapshot must live as long as functions of this tick run. Existing fields are replaced without allocation.
  void refill(const Snapshot& snapshot, std::int64_t now_ns);
  // From now on fills the field that the string at `key` names. False: the part has no such field.
  bool read_first(lua_State* state, std::size_t part, int key);
  // From now on fills all fields of a part.
  void read_whole(lua_State* state, std::size_t part);

 private:
  using Kind = StatusField::Part;
  using Type = StatusField::Type;
  struct Part {
    Kind kind;
    std::uint32_t index;
    std::bitset<512> read{};  // its fields that were read
  };
  struct Read {
    std::uint16_t part, field;
  };

  void open_shelf(lua_State* state);
  void put_on_shelf(lua_State* state);
  int content(std::size_t part) const noexcept { return static_cast<int>(fields_.size() + part) + 1; }
  void push_names(lua_State* state);
  static int push_choices(lua_State* state, const StatusField& field);
  void push_part(lua_State* state, Kind kind, std::size_t index);
  void finish_part(lua_State* state, std::size_t number, const char* shown);
  void push_whole_part(lua_State* state, Kind kind, std::size_t index, const char* shown);
  void push_joints(lua_State* state, const RobotModel& model);
  void push_seen(lua_State* state, const std::vector<SeenInfo>& entries);
  void read_field(lua_State* state, std::size_t part, std::size_t field);
  void push_value(lua_State* state, std::size_t field, std::size_t index) const;

  bool on_demand_ = true;
  std::vector<Part> parts_;
  std::vector<Read> read_;  // by part
  Snapshot nothing_{};
  const Snapshot* snapshot_ = &nothing_;
  std::int64_t now_ns_ = 0;
  std::vector<StatusField> fields_;
  std::vector<int> choices_;  // registry references, by field
  // A coroutine that never runs. On its stack lie the names of the fields, and then the contents of the parts, so that
  // a tick need not fetch them from tables. What is done there must not raise: nothing would catch it.
  lua_State* shelf_ = nullptr;
  int event_ = LUA_NOREF;
};

// Finds the number of slots of a table, empty ones included. The time to go through a table is proportional to its
// slots, not to its elements, and a script may fill a table and empty it again. Lua's API does not give this number.
//
// So it is read from LuaJIT's own data. Its place is found in each state by comparing tables of known sizes. When the
// place is not found, every table counts as if it filled the largest allowed block of memory.
class TableSlots {
 public:
  // [-0 +0] Raises when out of memory.
  void find_place(lua_State* state);
  // The steps (StepMeter) to go through the table at `index` once.
  std::size_t steps(lua_State* state, int index) const noexcept;
  bool known() const noexcept { return place_ >= 0; }

 private:
  std::ptrdiff_t place_ = -1;  // in bytes from the table's address; -1: unknown
};

// Charges for going through the table at `index` once. Raises.
void charge_table(lua_State* state, int index);

}  // namespace kadans
