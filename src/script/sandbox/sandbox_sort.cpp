// sort(table [, before]): as in Lua, by merging. So equal elements keep their order, and an order that contradicts
// itself costs no more than another: n log n comparisons, each charged with what it compares.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "library_function.h"
#include "sandbox.h"
#include "step_meter.h"

namespace kadans {
namespace {

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

}  // namespace

int sandbox_sort(lua_State* state) {
  check_writable(state);
  if (!lua_isnoneornil(state, 2)) luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_settop(state, 2);
  begin_callback(state, "table.sort");
  Sorting(state, static_cast<std::uint32_t>(lua_objlen(state, 1))).run();
  end_callback(state);
  return 0;
}

}  // namespace kadans
