// What a script may do in one go: so many instructions, so much wall time, so much memory.
//
// A hook runs every thousand instructions. When a limit is passed it raises; since a script may catch that with pcall,
// it also re-arms itself to raise again at every single instruction that follows, so that no loop around a pcall
// survives. Functions of the library that work long in C are charged for it, before they begin.
#pragma once

#include <cstdint>

#include "kadans/script/lua_heap.h"
#include "kadans/script/script_error.h"

struct lua_State;
struct lua_Debug;

namespace kadans {

class Budget {
 public:
  Budget(LuaHeap& heap, ScriptError& error) noexcept : heap_(heap), error_(error) {}

  // Begins a new count. wall_ns 0: no limit on wall time.
  void begin(lua_State* state, std::uint64_t instructions, std::int64_t wall_ns) noexcept;

  // Counts work done in C as instructions. Raises when the budget does not allow it.
  void charge(lua_State* state, double instructions);

  // Whether a limit was passed since begin(): whatever the script caught, it is stopped.
  bool breached() const noexcept { return error_.breach != ScriptBreach::none; }
  std::uint64_t left() const noexcept { return spent_ < limit_ ? limit_ - spent_ : 0; }
  std::uint64_t limit() const noexcept { return limit_; }
  std::uint64_t spent() const noexcept { return spent_; }

  // Raises the breach again, if there is one: for whatever catches errors.
  void raise_again(lua_State* state);
  // From inside an allocation that passed the limit: stops the script at its next instruction. When the block was not
  // `granted`, Lua raises at once, so the place is noted now.
  void memory_ran_out(lua_State* state, bool granted) noexcept;

 private:
  static constexpr int interval = 1000;
  static void hook(lua_State* state, lua_Debug* activation);
  void look(lua_State* state);
  void breach(lua_State* state, ScriptBreach what) noexcept;

  LuaHeap& heap_;
  ScriptError& error_;
  std::uint64_t limit_ = 0, spent_ = 0;
  std::int64_t wall_ns_ = 0, wall_end_ns_ = 0;
};

}  // namespace kadans
