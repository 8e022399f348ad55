// The table library under a budget, and `pairs` in an order that is the same in every run: numbers, then strings, each
// sorted. (LuaJIT's own order of string keys differs from process to process.)
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

#include "handle.h"
#include "sandbox.h"
#include "script/lua/lua_core.h"

namespace kadans {
namespace {

constexpr std::size_t joined_steps = 48, joined_number_steps = 1200, moved_steps = 64;  // of an element
constexpr double skipped_instructions = 6;

struct Key {
  int rank;  // 0: number, 1: string, 2: boolean
  lua_Number number;
  const char* text;
  std::size_t length;
};

bool before(const Key& a, const Key& b) noexcept {
  if (a.rank != b.rank) return a.rank < b.rank;
  if (a.rank != 1) return a.number < b.number;
  const int order = std::memcmp(a.text, b.text, std::min(a.length, b.length));
  return order != 0 ? order < 0 : a.length < b.length;
}

Key key_at_top(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER:
      return {0, lua_tonumber(state, index), nullptr, 0};
    case LUA_TSTRING: {
      Key key{1, 0, nullptr, 0};
      key.text = lua_tolstring(state, index, &key.length);
      return key;
    }
    case LUA_TBOOLEAN:
      return {2, lua_toboolean(state, index) != 0 ? 1.0 : 0.0, nullptr, 0};
    default:
      luaL_error(state, "pairs: keys of type %s have no order", luaL_typename(state, index));
      return {};
  }
}

// What it takes to sort so many keys.
double sorting_instructions(std::size_t count) noexcept {
  return static_cast<double>(count) * (16 + 2 * std::log2(static_cast<double>(count) + 1));
}

// [-0 +1] The keys of the table at `table` as a sorted array.
void push_sorted_keys(lua_State* state, int table) {
  charge_table(state, table);
  charge_table(state, table);
  std::size_t count = 0;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) ++count;
  core_of(state).budget.charge(state, sorting_instructions(count));
  auto* keys = static_cast<Key*>(lua_newuserdata(state, (count + 1) * sizeof(Key)));
  std::size_t at = 0;
  for (lua_pushnil(state); lua_next(state, table) != 0; lua_pop(state, 1)) keys[at++] = key_at_top(state, -2);
  std::sort(keys, keys + count, before);
  lua_createtable(state, static_cast<int>(count), 0);
  for (std::size_t i = 0; i < count; ++i) {
    if (keys[i].rank == 0) {
      lua_pushnumber(state, keys[i].number);
    } else if (keys[i].rank == 1) {
      lua_pushlstring(state, keys[i].text, keys[i].length);
    } else {
      lua_pushboolean(state, keys[i].number != 0 ? 1 : 0);
    }
    lua_rawseti(state, -2, static_cast<int>(i + 1));
  }
  lua_remove(state, -2);
}

// Upvalues: the table, its sorted keys, how many were visited. Keys that are gone are passed over.
int next_pair(lua_State* state) {
  auto visited = static_cast<int>(lua_tointeger(state, lua_upvalueindex(3)));
  for (;;) {
    lua_settop(state, 0);
    lua_rawgeti(state, lua_upvalueindex(2), ++visited);
    if (lua_isnil(state, 1)) return 1;
    lua_pushvalue(state, 1);
    lua_rawget(state, lua_upvalueindex(1));
    if (!lua_isnil(state, 2)) break;
    core_of(state).budget.charge(state, skipped_instructions);
  }
  lua_pushinteger(state, visited);
  lua_replace(state, lua_upvalueindex(3));
  return 2;
}

// Raises when the first argument is no table, or a read-only one.
void check_writable(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  if (push_content(state, 1)) luaL_error(state, "this table is read-only");
}

// What is at `from` to `to`, which takes no key that stays empty.
void move_element(lua_State* state, std::int64_t from, std::int64_t to) {
  lua_rawgeti(state, 1, static_cast<int>(to));
  lua_rawgeti(state, 1, static_cast<int>(from));
  if (lua_isnil(state, -1) && lua_isnil(state, -2)) return lua_pop(state, 2);
  lua_rawseti(state, 1, static_cast<int>(to));
  lua_pop(state, 1);
}

// insert(table [, position], value): as in Lua; all elements from the position on move, and what is between. A key that
// is new may take the whole table to be made anew: the memory for that is counted, so it is looked at each time.
int insert(lua_State* state) {
  check_writable(state);
  const int count = lua_gettop(state);
  if (count != 2 && count != 3) return luaL_error(state, "wrong number of arguments to 'insert'");
  const std::int64_t end = static_cast<std::int64_t>(lua_objlen(state, 1)) + 1;
  const std::int64_t position = count == 2 ? end : to_place(luaL_checknumber(state, 2));
  StepMeter meter(state);
  for (std::int64_t i = end; i > position; --i) {
    meter.spend(moved_steps);
    move_element(state, i - 1, i);
    if (core_of(state).heap.exceeded()) meter.settle();
  }
  meter.settle();
  lua_settop(state, count);
  lua_rawseti(state, 1, static_cast<int>(position));
  return 0;
}

// remove(table [, position]): as in Lua, and written in it, so that its instructions count.
int remove(lua_State* state) {
  check_writable(state);
  return forward(state);
}

// maxn(table): as in Lua; looks at every slot.
int maxn(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  charge_table(state, 1);
  return forward(state);
}

// concat(table [, separator [, from [, to]]]): as in Lua.
int concat(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  std::size_t length = 0;
  const char* separator = luaL_optlstring(state, 2, "", &length);
  const std::int64_t first = optional_place(state, 3, 1);
  const std::int64_t last = optional_place(state, 4, static_cast<std::int32_t>(lua_objlen(state, 1)));
  lua_settop(state, 2);
  StepMeter meter(state);
  luaL_Buffer buffer;
  luaL_buffinit(state, &buffer);
  for (std::int64_t i = first; i <= last; ++i) {
    lua_rawgeti(state, 1, static_cast<int>(i));
    const int type = lua_type(state, -1);
    if (type != LUA_TSTRING && type != LUA_TNUMBER)
      return luaL_error(state, "invalid value (%s) at index %d in table for 'concat'", lua_typename(state, type),
                        static_cast<int>(i));
    meter.spend(type == LUA_TNUMBER ? joined_number_steps : joined_steps + StepMeter::of_bytes(lua_objlen(state, -1)));
    luaL_addvalue(&buffer);
    if (i == last) break;
    meter.spend(StepMeter::of_bytes(length));
    luaL_addlstring(&buffer, separator, length);
  }
  luaL_pushresult(&buffer);
  meter.settle();
  return 1;
}

constexpr std::size_t element_steps = 64, comparison_steps = 80, call_steps = 160;

// Sorts numbers of elements. On the stack: the table, `before` or nil, a copy of the elements, the memory of both
// halves.
class Sorting {
 public:
  Sorting(lua_State* state, std::uint32_t count) : state_(state), meter_(state), count_(count) {
    lua_createtable(state, static_cast<int>(count), 0);
    auto* const numbers = static_cast<std::uint32_t*>(lua_newuserdata(state, 2 * count * sizeof(std::uint32_t)));
    from_ = numbers;
    to_ = numbers + count;
  }

  void run() {
    copy_elements();
    for (std::uint32_t width = 1; width < count_; width *= 2) {
      for (std::uint32_t first = 0; first < count_; first += 2 * width)
        merge(first, std::min(first + width, count_), std::min(first + 2 * width, count_));
      std::swap(from_, to_);
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
      lua_rawgeti(state_, copy, static_cast<int>(from_[i]));
      lua_rawseti(state_, table, static_cast<int>(i + 1));
    }
    meter_.settle();
  }

 private:
  enum Place : int { table = 1, before = 2, copy = 3 };

  void copy_elements() {
    for (std::uint32_t i = 0; i < count_; ++i) {
      meter_.spend(element_steps);
      from_[i] = i + 1;
      lua_rawgeti(state_, table, static_cast<int>(i + 1));
      lua_rawseti(state_, copy, static_cast<int>(i + 1));
    }
  }

  void merge(std::uint32_t first, std::uint32_t middle, std::uint32_t last) {
    std::uint32_t left = first, right = middle;
    for (std::uint32_t at = first; at < last; ++at) {
      const bool takes_right = left == middle || (right < last && is_before(from_[right], from_[left]));
      to_[at] = from_[takes_right ? right++ : left++];
    }
  }

  bool is_before(std::uint32_t a, std::uint32_t b) {
    const bool calls = !lua_isnil(state_, before);
    if (calls) lua_pushvalue(state_, before);
    lua_rawgeti(state_, copy, static_cast<int>(a));
    lua_rawgeti(state_, copy, static_cast<int>(b));
    bool yes = false;
    if (calls) {
      meter_.spend(call_steps);
      lua_call(state_, 2, 1);
      yes = lua_toboolean(state_, -1) != 0;
      lua_pop(state_, 1);
    } else {
      meter_.spend(comparison_steps);
      if (lua_type(state_, -1) == LUA_TSTRING && lua_type(state_, -2) == LUA_TSTRING)
        meter_.spend(StepMeter::of_bytes(std::min(lua_objlen(state_, -1), lua_objlen(state_, -2))));
      yes = lua_lessthan(state_, -2, -1) != 0;
      lua_pop(state_, 2);
    }
    return yes;
  }

  lua_State* state_;
  StepMeter meter_;
  std::uint32_t count_;
  std::uint32_t* from_;
  std::uint32_t* to_;
};

// sort(table [, before]): as in Lua, by merging. So equal elements keep their order, and an order that contradicts
// itself costs no more than another: n log n comparisons, each charged with what it compares.
int sort(lua_State* state) {
  check_writable(state);
  if (!lua_isnoneornil(state, 2)) luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_settop(state, 2);
  begin_callback(state, "table.sort");
  Sorting(state, static_cast<std::uint32_t>(lua_objlen(state, 1))).run();
  end_callback(state);
  return 0;
}

}  // namespace

int sandbox_pairs(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  if (push_content(state, 1)) lua_replace(state, 1);
  push_sorted_keys(state, 1);
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, next_pair, 3);
  return 1;
}

void open_tables(lua_State* state) {
  const luaL_Reg functions[] = {{"concat", concat}, {"insert", insert}, {"sort", sort}};
  wrap(state, "remove", remove);
  wrap(state, "maxn", maxn);
  set_functions(state, functions);
}

}  // namespace kadans
